// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/truth.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

/// Interpolates between the two nearest stamps. Extrapolates from the first or last two.
std::optional<Time> true_time(const TrueClock& clock, Time stamp) {
  const auto& stamps = clock.stamps_ns;
  if (stamps.size() < 2) return std::nullopt;
  // Both ends are excluded, so that a stamp outside uses the first or last two pairs.
  const auto behind = std::upper_bound(stamps.begin() + 1, stamps.end() - 1, to_ns(stamp));
  const auto i = static_cast<std::size_t>(behind - stamps.begin()) - 1;
  const std::int64_t step = stamps[i + 1] - stamps[i];
  const std::int64_t run = clock.times_ns[i + 1] - clock.times_ns[i];
  // The slope is close to 1. Only its difference from 1 is computed, which loses no digits.
  const std::int64_t within = to_ns(stamp) - stamps[i];
  const double extra =
      static_cast<double>(within) * (static_cast<double>(run - step) / static_cast<double>(step));
  const double most = static_cast<double>(most_true_ns);
  return utc_time(clock.times_ns[i] + within + std::llround(std::clamp(extra, -most, most)));
}

std::int64_t TrueMocap::frame_ns(std::uint64_t frame) const {
  return first_frame_ns + std::llround(static_cast<double>(frame) * 1e9 / rate_hz);
}

}  // namespace kinalign
