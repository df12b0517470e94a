// SPDX-License-Identifier: Apache-2.0
// The clock of a device that numbers its frames and sends them at a steady rate. The frame number
// serves as the counter, and the earliest arrivals determine the model.
#pragma once

#include "kinalign/clock/offline/device_clock.h"
#include "kinalign/core/error.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A frame with its unwrapped number. A device that starts a new count begins a new life.
struct CountedFrame {
  BootKey life = 0;
  std::int64_t number = 0;
  HostTime arrival{};
};

/// The clock of a device that counts its frames, learnt from all of them.
struct CountedClock {
  double step_ns = 0.0;  // between two numbers
  DeviceClock clock;     // for the counter number * step
  Findings findings;     // one if the stated rate is wrong
};

/// `stated_step_ns`: 0 if it is unknown. It is used while the arrivals agree with it within 1 %.
CountedClock counted_clock(std::vector<CountedFrame> frames, double stated_step_ns,
                           Duration utc_minus_host, const std::string& file);

/// The device's counter at a frame: its number times the step, as the clock model expects it.
NodeTime counter_of(const CountedFrame& frame, double step_ns);

}  // namespace kinalign
