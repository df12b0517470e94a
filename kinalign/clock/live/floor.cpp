// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/floor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinalign {

namespace {

constexpr double remembered_s = 100.0;
constexpr std::size_t nearest = 6;  // number of gaps between bounds that give a density
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double resolution_s = 1e-6;

// Class 0: below 1 us. Class i: from 2^(i-1) us. The last class has no upper limit.
std::size_t class_of(double excess) {
  if (excess < resolution_s) return 0;
  return std::min<std::size_t>(23, 1 + static_cast<std::size_t>(std::ilogb(excess / resolution_s)));
}

}  // namespace

// If k delays lie within a distance d above the lowest delay, the density is k / d. Only the lowest
// delays are used, because the density falls with the distance.
double density_above(std::span<double> excess) {
  if (excess.size() < 2) return 0.0;
  const std::size_t k = std::min(nearest, excess.size() - 1);
  const auto place = excess.begin() + static_cast<std::ptrdiff_t>(k);
  std::nth_element(excess.begin(), place, excess.end());
  return static_cast<double>(k) / std::max(*place, resolution_s / 4.0);
}

void ExcessCounts::add(double excess) {
  ++classes_[class_of(excess)];
  ++total_;
}

std::uint64_t ExcessCounts::above(double excess) const {
  std::uint64_t count = 0;
  for (std::size_t i = class_of(excess); i < classes_.size(); ++i) count += classes_[i];
  return count;
}

double ExcessCounts::median() const {
  std::uint64_t count = 0;
  std::size_t i = 0;
  while (i + 1 < classes_.size() && 2 * (count += classes_[i]) < total_) ++i;
  return std::ldexp(resolution_s, static_cast<int>(i));
}

void Floor::add(OffsetBound bound, const FloorLine& line) {
  counts_.add(line.excess(bound));
  keep_low(bound, line);
  hull_.add(bound.s, bound.x);
}

/// Replaces a bound of a full set: an old bound if there is one, otherwise the highest above the
/// floor.
void Floor::keep_low(OffsetBound bound, const FloorLine& line) {
  if (lows_ < low_.size()) {
    low_[lows_++] = bound;
    return;
  }
  const auto cost = [&](const OffsetBound& b) {
    return b.s < bound.s - remembered_s ? infinite : line.excess(b);
  };
  std::size_t worst = 0;
  double most = cost(low_[0]);
  for (std::size_t i = 1; i < lows_; ++i) {
    if (const double c = cost(low_[i]); c > most) {
      worst = i;
      most = c;
    }
  }
  if (line.excess(bound) < most) low_[worst] = bound;
}

double Floor::density(const FloorLine& line) const {
  std::array<double, 12> excess{};
  for (std::size_t i = 0; i < lows_; ++i) excess[i] = line.excess(low_[i]);
  return density_above(std::span(excess).first(lows_));
}

}  // namespace kinalign
