// SPDX-License-Identifier: Apache-2.0
// Delays just above a floor have a density, in delays per second of delay. The likelihood of a
// height of the floor is exp(density * height) up to the lowest point, and zero above it.
// Integrating over the heights of both floors gives the likelihood exp(density * g(b)) of a slope
// b; g is the gap between the hulls. The peak of g is the widest line (corridor.h). This file
// computes the mean.
#include "kinalign/clock/live/route.h"

#include "kinalign/clock/assumptions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kinalign {

namespace {

constexpr std::size_t grid = 24;  // number of slopes that are averaged
constexpr double reach = 5.0;     // range of these slopes on each side, in standard deviations
constexpr int most_rounds = 24;
constexpr double least_deviation = 1e-15;  // a slope of 1 us in thirty years
constexpr double far_beyond = 1e4;         // nats; evidence from sharp floors may reach hundreds

/// The slopes of the grid and the results for each slope; arrays [grid].
struct Slopes {
  std::array<double, grid> slope{}, middle{}, gap{}, likelihood{};
  std::size_t likeliest = 0;
};

struct Evidence {
  const LiftedHull& above;
  const LiftedHull& below;
  double t, density;
};

/// Negative logarithm of the prior probability of a slope, in nats. A few crystals are far worse
/// than most; no crystal is worse than 100 ppm.
double surprise(double slope, const SlopeBelief& prior) {
  const double off = std::abs(slope - prior.mean) / prior.deviation;
  const double beyond = std::max(0.0, std::abs(slope) - greatest_rate) / SlopeBelief{}.deviation;
  return (off < 2.0 ? off * off / 2.0 : 2.0 * off - 2.0) + far_beyond * beyond * beyond;
}

/// Computes the likelihood of each slope of the grid, relative to the greatest.
Slopes weigh(const Evidence& e, const SlopeBelief& prior, const SlopeBelief& around) {
  Slopes s;
  const double first = around.mean - reach * around.deviation;
  const double step = 2.0 * reach * around.deviation / (grid - 1);
  std::array<double, grid> above{}, below{};  // `below` has changed sign, so its slopes fall
  e.above.bounds_at(e.t, first, step, above);
  e.below.bounds_at(e.t, -first - step * (grid - 1), step, below);
  for (std::size_t i = 0; i < grid; ++i) {
    const double lower = -below[grid - 1 - i];
    s.slope[i] = first + step * static_cast<double>(i);
    s.middle[i] = (above[i] + lower) / 2.0;
    s.gap[i] = above[i] - lower;
    s.likelihood[i] = e.density * s.gap[i] - surprise(s.slope[i], prior);
    if (s.likelihood[i] > s.likelihood[s.likeliest]) s.likeliest = i;
  }
  const double most = s.likelihood[s.likeliest];
  for (double& l : s.likelihood) l = std::exp(l - most);
  return s;
}

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

Moments moments(const std::array<double, grid>& values, const std::array<double, grid>& weights) {
  double sum = 0.0, first = 0.0, second = 0.0;
  for (std::size_t i = 0; i < grid; ++i) {
    sum += weights[i];
    first += weights[i] * values[i];
  }
  first /= sum;
  for (std::size_t i = 0; i < grid; ++i) {
    second += weights[i] * (values[i] - first) * (values[i] - first);
  }
  return {first, std::sqrt(second / sum)};
}

/// Returns a better position and width of the grid, or nothing if the grid fitted the result.
std::optional<SlopeBelief> better_grid(const Slopes& s, const Moments& found, double deviation) {
  const double step = 2.0 * reach * deviation / (grid - 1);
  if (s.likeliest <= 1 || s.likeliest >= grid - 2) {
    return SlopeBelief{s.slope[s.likeliest], 2.0 * deviation};
  }
  if (found.deviation > 1.8 * deviation) return SlopeBelief{found.mean, found.deviation};
  if (found.deviation < 0.7 * step && deviation > least_deviation) {
    return SlopeBelief{s.slope[s.likeliest], std::max(0.7 * step, least_deviation)};
  }
  return std::nullopt;
}

}  // namespace

FloorLine Middle::floor(Side side) const {
  const double sign = side == Side::above ? 1.0 : -1.0;
  return {t, sign * value + round_trip / 2.0, sign * slope};
}

double Middle::floor_deviation() const {
  if (!sharp()) return 1.0;
  return std::hypot(1.0 / above_density, 1.0 / below_density);
}

void Route::add(Side side, OffsetBound bound, const Middle& middle) {
  (side == Side::above ? above_ : below_).add(bound, middle.floor(side));
}

Middle Route::middle(double t, const Middle& last) {
  Middle known;
  known.above_density = above_.density(last.floor(Side::above));
  known.below_density = below_.density(last.floor(Side::below));
  return average(t, known, belief_);
}

Middle Route::middle_elsewhere(double t, const Middle& now) const {
  SlopeBelief around = belief_;
  return average(t, now, around);
}

// The grid of slopes is moved and scaled until the likely slopes are within it and several grid
// points are likely.
Middle Route::average(double t, const Middle& known, SlopeBelief& around) const {
  const bool sharp = known.sharp();
  const double above_gap = sharp ? 1.0 / known.above_density : 0.0;
  const double below_gap = sharp ? 1.0 / known.below_density : 0.0;
  const Evidence evidence{above_.hull(), below_.hull(), t,
                          sharp ? 2.0 / (above_gap + below_gap) : 0.0};
  for (int round = 0;; ++round) {
    const Slopes s = weigh(evidence, prior_, around);
    const Moments slope = moments(s.slope, s.likelihood);
    const auto better = better_grid(s, slope, around.deviation);
    if (better && round < most_rounds) {
      around = *better;
      continue;
    }
    around = {slope.mean, std::max(slope.deviation, least_deviation)};
    const Moments value = moments(s.middle, s.likelihood);
    Middle middle = known;
    middle.t = t;
    middle.slope = slope.mean;
    middle.value = value.mean;
    // On average a floor is one gap between points below its lowest point.
    middle.round_trip = moments(s.gap, s.likelihood).mean - above_gap - below_gap;
    middle.deviation =
        sharp ? std::hypot(value.deviation, std::hypot(above_gap, below_gap) / 2.0) : 1.0;
    return middle;
  }
}

}  // namespace kinalign
