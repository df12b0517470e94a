// SPDX-License-Identifier: Apache-2.0
// The clock of a device that numbers its frames and sends them at a steady rate. The frame number
// times the time between frames serves as the device's counter. The earliest arrivals determine the
// clock model.
#pragma once

#include "kinalign/recording/streams/device_rows.h"

#include <cstdint>
#include <vector>

namespace kinalign {

/// A frame with its unwrapped number. If a device begins a new count, `life` changes.
struct CountedFrame {
  BootKey life = 0;
  std::int64_t number = 0;
  HostTime arrival{};
};

/// Learns the clock of a device from all its frames. The results are `learned.clock` and
/// `learned.step_ns`, the time between two numbers. A rate in the options replaces `stated_step_ns`
/// (0: unknown). The stated time is used if the arrivals agree with it within 1 %. Otherwise the
/// measured time is used, and there is a finding.
void count_clock(std::vector<CountedFrame> frames, double stated_step_ns,
                 const DeviceRequest& request, LearnedDevice& learned);

/// The device's counter at a frame, as the clock model expects it: the frame's number times
/// `step_ns`.
NodeTime counter_of(const CountedFrame& frame, double step_ns);

}  // namespace kinalign
