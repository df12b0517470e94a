// SPDX-License-Identifier: Apache-2.0
// Converts stamps on the host's raw clock to UTC, using pairs of readings that are stored during
// recording.
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

/// A step of the wall clock between two pairs of readings.
struct WallClockStep {
  HostTime at{};  // time of the later pair
  Duration by{};
};

/// One offset for a whole recording, so that durations are those of the raw clock. The wall clock
/// only gives the date, and later changes of the wall clock have no effect. The error is the drift
/// of the host's crystal, about 20 ppm.
struct UtcAnchor {
  Duration utc_minus_raw{};          // computed from the first pair
  std::vector<WallClockStep> steps;  // changes above a millisecond that no slew explains
};

/// Pairs must be in the order of reading. Absent if there is no pair.
std::optional<UtcAnchor> utc_anchor(std::span<const ClockPair> pairs);

}  // namespace kinalign
