// SPDX-License-Identifier: Apache-2.0
// Selects the frames of a skeleton for viewers. Viewers draw at most 30 frames per second, and a
// frame of 59 joints has 12 kB of text.
#pragma once

#include "kinalign/wire/time.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace kinalign {

/// Selects on average at most 30 frames per second, and at most 31 within any second. `due_`
/// advances by whole steps, not by the intervals between frames, so jitter does not accumulate.
class ShownPace {
 public:
  /// Returns whether the frame at this time is shown. Call for all frames in order.
  bool shows(Time at) {
    const bool went_back = due_ && at + step + early < *due_;  // before the frame shown last
    if (due_ && at + early < *due_ && !went_back) return false;
    // The first frame, and the first frame after a step back, are always shown.
    const bool follows = due_ && !went_back;
    due_ = follows ? std::max(*due_, at - early) + step : at + step;
    return true;
  }

 private:
  static constexpr Duration step{1'000'000'000 / 30};
  // Chosen limit. It exceeds the jitter of a 30 Hz device, so none of its frames is omitted. It is
  // less than half a step, so every second frame of a 60 Hz device is shown.
  static constexpr Duration early = std::chrono::milliseconds(4);

  // The member is absent before the first frame.
  std::optional<Time> due_;  // time of the next frame; increases by at least one step
};

}  // namespace kinalign
