// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/posix_board.h"

#include "firmware/host_node/formula.h"

#include <ctime>

namespace kinalign {

std::int64_t raw_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC_RAW, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

bool PosixBoard::read_imu(NodeSample& sample) {
  // A clockless node never asks, so the sensor's time is read here; the node does not get it.
  if (options_.clockless) counter_us();
  sample = swing_at(asked_us_, options_.orientation);
  ++readings_;
  return options_.sensor_fails_every == 0 || readings_ % options_.sensor_fails_every != 0;
}

bool PosixBoard::read_battery(std::uint16_t& mv) {
  mv = static_cast<std::uint16_t>(options_.battery_mv);
  return options_.battery_mv != 0;
}

}  // namespace kinalign
