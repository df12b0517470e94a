// SPDX-License-Identifier: Apache-2.0
// Chooses the frames of a skeleton for viewers: they draw at most 30 a second, and 59 joints are 12
// kB of text.
#pragma once

#include "kinalign/wire/time.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace kinalign {

/// Selects at most 30 frames a second in the long run, and 31 within any one second. `due_`
/// advances by whole steps, not by the intervals between frames, so jitter does not accumulate.
class ShownPace {
 public:
  /// True if the frame at that time is shown. Call it for the frames in their order.
  bool shows(Time at) {
    const bool went_back = due_ && at + step + early < *due_;  // lies before the frame shown last
    if (due_ && at + early < *due_ && !went_back) return false;
    // The first frame, and the first after a step back, start the turns anew.
    const bool follows = due_ && !went_back;
    due_ = follows ? std::max(*due_, at - early) + step : at + step;
    return true;
  }

 private:
  static constexpr Duration step{1'000'000'000 / 30};
  // Chosen limit: more than the jitter of a 30 Hz device, so that none of its frames is left out,
  // and less than half a step, so that every second frame of a 60 Hz device is shown.
  static constexpr Duration early = std::chrono::milliseconds(4);

  // Absent before the first frame.
  std::optional<Time> due_;  // time of the next frame; moves on by at least a step
};

}  // namespace kinalign
