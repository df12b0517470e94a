// SPDX-License-Identifier: Apache-2.0
// The clock of a device that numbers its frames and sends them at a steady rate. The frame number
// serves as the counter, and the earliest arrivals determine the model.
#pragma once

#include "kinalign/recording/streams/device_rows.h"

#include <cstdint>
#include <vector>

namespace kinalign {

/// A frame with its unwrapped number. A device that starts a new count begins a new life.
struct CountedFrame {
  BootKey life = 0;
  std::int64_t number = 0;
  HostTime arrival{};
};

/// Learns the clock of a device that counts its frames from all of them: `learned.clock` and
/// `learned.step_ns`, the time between two numbers. The rate in the options has precedence over
/// `stated_step_ns` (0: unknown). The stated rate is used while the arrivals agree with it within
/// 1 %; otherwise there is a finding.
void count_clock(std::vector<CountedFrame> frames, double stated_step_ns,
                 const DeviceRequest& request, LearnedDevice& learned);

/// The device's counter at a frame: its number times the step, as the clock model expects it.
NodeTime counter_of(const CountedFrame& frame, double step_ns);

}  // namespace kinalign
