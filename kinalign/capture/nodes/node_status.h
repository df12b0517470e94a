// SPDX-License-Identifier: Apache-2.0
// The state of one node while it sends: its counts, its rate, its clock.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/clock/clock_stamp.h"
#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// How a node does.
struct NodeStatus {
  std::size_t stream = 0;
  std::uint32_t node_id = 0, boot_id = 0;
  NodeAddress address;
  bool silent = false, old_key = false;
  std::uint64_t lives = 0, accepted = 0, lost = 0;  // frames, of this life
  std::optional<double> rate_hz;            // absent before it is known, and of who is silent
  HostTime heard{};                         // last
  std::optional<std::uint16_t> battery_mv;  // where it says that
  // of its clock, where it has one
  std::optional<NodeTime> n;  // its newest counter, ...
  std::optional<ClockStamp> stamp;
  double drift = 0.0, drift_deviation = 0.0;  // host_from_node's rate less one, as estimated
  std::optional<Duration> round_trip;         // the least of the last whole ten seconds
  std::optional<Duration> one_way, mean_way;  // d of a node without a counter: the last, the mean
};

}  // namespace kinalign
