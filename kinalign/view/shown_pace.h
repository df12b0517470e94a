// SPDX-License-Identifier: Apache-2.0
// Which frames of a skeleton viewers are given: they draw no faster than 30 a second, and 59 joints
// are 12 kB of text.
#pragma once

#include "kinalign/wire/time.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace kinalign {

/// At most 30 a second in the long run, and 31 within any one second.
class ShownPace {
 public:
  /// Whether the frame at that time is shown; frames are asked for in their order.
  bool shows(Time at) {
    const bool went_back = due_ && at + step + early < *due_;  // lies before the one shown last
    if (due_ && at + early < *due_ && !went_back) return false;
    const bool follows = due_ && !went_back;
    due_ = follows ? std::max(*due_, at - early) + step : at + step;
    return true;
  }

 private:
  static constexpr Duration step{1'000'000'000 / 30};
  // Chosen: more than a 30 Hz device's frames jitter by, so that none of them is left out, and less
  // than half a step, so that a 60 Hz device's are shown by turns.
  static constexpr Duration early = std::chrono::milliseconds(4);

  std::optional<Time> due_;  // the next one; moves on by a step at least
};

}  // namespace kinalign
