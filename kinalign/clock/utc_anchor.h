// SPDX-License-Identifier: Apache-2.0
// UTC for what was stamped on the raw axis: from pairs of readings that are logged while recording.
#pragma once

#include "kinalign/wire/time.h"

#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// Both clocks of one host, read at once.
struct ClockPair {
  HostTime raw{};
  Time utc{};
};

inline constexpr double fastest_slew = 0.1;  // chronyd slews by up to 83,333 ppm

/// The wall clock was moved between two pairs.
struct WallClockStep {
  HostTime at{};  // of the later pair
  Duration by{};
};

/// One offset for a whole recording: durations stay those of the raw axis whatever befalls the wall
/// clock, which says when it was, not how long. That is off by what the crystal drifts, some 20
/// ppm.
struct UtcAnchor {
  Duration utc_minus_raw{};          // of the first pair
  std::vector<WallClockStep> steps;  // faster than any slew, and more than a millisecond
};

/// Pairs in the order in which they were read; absent where there is none.
std::optional<UtcAnchor> utc_anchor(std::span<const ClockPair> pairs);

Time utc_from_host(const UtcAnchor& anchor, HostTime t);

}  // namespace kinalign
