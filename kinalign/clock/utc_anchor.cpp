// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/utc_anchor.h"

#include <cmath>

namespace kinalign {

namespace {

constexpr double least_step_s = 1e-3;

Duration offset(const ClockPair& pair) {
  return pair.utc.time_since_epoch() - pair.raw.time_since_epoch();
}

}  // namespace

std::optional<UtcAnchor> utc_anchor(std::span<const ClockPair> pairs) {
  if (pairs.empty()) return std::nullopt;
  UtcAnchor anchor{offset(pairs.front()), {}};
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Duration by = offset(pairs[i]) - offset(pairs[i - 1]);
    const double allowed = fastest_slew * seconds(pairs[i].raw - pairs[i - 1].raw) + least_step_s;
    if (std::abs(seconds(by)) > allowed) anchor.steps.push_back({pairs[i].raw, by});
  }
  return anchor;
}

}  // namespace kinalign
