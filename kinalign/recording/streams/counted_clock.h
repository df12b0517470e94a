// SPDX-License-Identifier: Apache-2.0
// The clock of a device that numbers its frames and sends them by a steady rate: the number plays
// the part of a counter, the earliest arrivals tell the rest.
#pragma once

#include "kinalign/clock/offline/device_clock.h"
#include "kinalign/core/error.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A frame by its number, unwrapped. A life ends where the device counts anew.
struct CountedFrame {
  BootKey life = 0;
  std::int64_t number = 0;
  HostTime arrival{};
};

/// Goes on over the wraps of a sender's number, and begins a life where it counts anew.
class FrameNumbers {
 public:
  CountedFrame place(std::uint32_t number, HostTime arrival);
  /// Another connection, or another sender.
  void begin_life() { begins_ = true; }

 private:
  bool begins_ = true;
  BootKey life_ = 0;
  std::int64_t last_ = 0;
};

struct CountedClock {
  double step_ns = 0.0;  // of a number
  DeviceClock clock;     // of counters that are number * step
  Findings findings;     // that the rate is not the one stated
};

/// `stated_step_ns`, 0 where nobody says: believed while the arrivals are within 1 % of it.
CountedClock counted_clock(std::vector<CountedFrame> frames, double stated_step_ns,
                           Duration utc_minus_host, const std::string& file);

NodeTime counter_of(const CountedFrame& frame, double step_ns);

}  // namespace kinalign
