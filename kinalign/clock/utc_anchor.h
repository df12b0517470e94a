// SPDX-License-Identifier: Apache-2.0
// UTC for stamps on the raw axis, from pairs of readings that are logged while recording.
#pragma once

#include "kinalign/wire/time.h"

#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// Readings of both clocks of a host at the same moment.
struct ClockPair {
  HostTime raw{};
  Time utc{};
};

inline constexpr double fastest_slew = 0.1;  // chronyd slews by up to 83,333 ppm

/// A step of the wall clock between two pairs.
struct WallClockStep {
  HostTime at{};  // time of the later pair
  Duration by{};
};

/// A single offset for a whole recording, so that durations are always those of the raw axis. The
/// wall clock only gives the date, whatever happens to it later. The error is the crystal's drift,
/// some 20 ppm.
struct UtcAnchor {
  Duration utc_minus_raw{};          // from the first pair
  std::vector<WallClockStep> steps;  // changes faster than any slew and above a millisecond
};

/// Pairs in the order of reading; absent if there is none.
std::optional<UtcAnchor> utc_anchor(std::span<const ClockPair> pairs);

}  // namespace kinalign
