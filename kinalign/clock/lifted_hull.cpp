// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/lifted_hull.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace kinalign {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

/// Adds a point at the right end and removes corners that are no longer convex.
void LiftedHull::append(double s, double lifted) {
  if (!corners_.empty() && corners_.back().s == s) {
    if (lifted >= corners_.back().lifted) return;
    corners_.pop_back();
  }
  double slope = -infinite;
  while (!corners_.empty()) {
    slope = (lifted - corners_.back().lifted) / (s - corners_.back().s);
    if (corners_.size() == 1 || slope > corners_[corners_.size() - 2].slope) break;
    corners_.pop_back();
  }
  if (!corners_.empty()) corners_.back().slope = slope;
  if (corners_.size() == most_) corners_.erase(corners_.begin());
  corners_.push_back({s, lifted, infinite});
}

void LiftedHull::add(double s, double bound) {
  const double lifted = bound + rho_ * s * s / 2.0;
  if (corners_.empty() || s >= corners_.back().s) return append(s, lifted);
  const auto behind = std::upper_bound(corners_.begin(), corners_.end(), s,
                                       [](double at, const Corner& c) { return at < c.s; });
  const std::vector<Corner> later(behind, corners_.end());
  corners_.erase(behind, corners_.end());
  if (!corners_.empty()) corners_.back().slope = infinite;
  append(s, lifted);
  for (const Corner& c : later) append(c.s, c.lifted);
}

LiftedHull::Support LiftedHull::support(const Corner& corner, double t, double slope) const {
  const double tau = corner.s - t;
  return {corner.lifted - rho_ * t * (corner.s - t / 2.0) - slope * tau, tau};
}

/// Returns the corner at which a line of this slope touches the hull of the lifted points.
std::vector<LiftedHull::Corner>::const_iterator LiftedHull::corner_for(double slope) const {
  return std::partition_point(corners_.begin(), corners_.end() - 1,
                              [slope](const Corner& c) { return c.slope < slope; });
}

LiftedHull::Support LiftedHull::at(double t, double slope) const {
  assert(!corners_.empty());
  return support(*corner_for(slope + rho_ * t), t, slope);
}

void LiftedHull::bounds_at(double t, double first, double step, std::span<double> bounds) const {
  assert(!corners_.empty());
  auto corner = corner_for(first + rho_ * t);
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double slope = first + step * static_cast<double>(i);
    // The loop ends at the last corner at the latest, because its slope is infinite.
    while (corner->slope < slope + rho_ * t) ++corner;
    bounds[i] = support(*corner, t, slope).bound;
  }
}

LiftedHull::Peak LiftedHull::peak(double t) const {
  assert(!corners_.empty());
  const auto behind = std::partition_point(corners_.begin(), corners_.end() - 1,
                                           [t](const Corner& c) { return c.s < t; });
  // No corner lies after t, so the bound grows without limit.
  if (behind->s < t) return {infinite, infinite};
  if (behind == corners_.begin()) {
    return {behind->s > t ? infinite : support(*behind, t, 0.0).bound, -infinite};
  }
  const double slope = (behind - 1)->slope - rho_ * t;
  return {support(*behind, t, slope).bound, slope};
}

LiftedHull LiftedHull::relifted(double rho) const {
  LiftedHull hull(rho, most_);
  for (const Corner& c : corners_) hull.add(c.s, c.lifted - rho_ * c.s * c.s / 2.0);
  return hull;
}

}  // namespace kinalign
