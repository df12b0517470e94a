// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/node_clock.h"

#include "kinalign/simulate/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr double grid_s = 0.1;
constexpr double first_reading_s = 5.0;   // the node started before the recording
constexpr std::size_t grid_margin = 200;  // steps of the grid after the end of the recording
constexpr double pi = std::numbers::pi;

/// Returns the frequency error at t caused by `ramp` and `curvature`. It is the integral of ramp +
/// curvature sin(w t), so it is 0 at t = 0.
double bend(const NodeClockOptions& o, double t) {
  const double w = 2.0 * pi / o.period_s;
  return o.ramp * t + o.curvature / w * (1.0 - std::cos(w * t));
}

}  // namespace

SimulatedClock::SimulatedClock(std::uint64_t seed, double length_s,
                               const NodeClockOptions& options) {
  const RandomStream noise(seed, 1), parameters(seed, 2);
  const double drawn = (40.0 * parameters.uniform(0, 0) - 20.0) * 1e-6;
  const double constant = options.frequency_error.value_or(drawn);
  const double per_degree =
      options.temperature ? (0.6 * parameters.uniform(0, 1) - 0.3) * 1e-6 : 0.0;
  const double phase = parameters.uniform(0, 2);

  const auto points = static_cast<std::size_t>(length_s / grid_s) + grid_margin;
  readings_.resize(points);
  double walk = 0.0, offset = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    const double t = grid_s * static_cast<double>(i);
    readings_[i] = first_reading_s + t + offset;
    walk += 1e-9 * std::sqrt(grid_s) * noise.normal(i, 0);
    const double white = 1e-9 / std::sqrt(grid_s) * noise.normal(i, 2);
    // Warming by 12 degrees with a time constant of four minutes, and a slow variation of one
    // degree.
    const double degrees =
        12.0 * (1.0 - std::exp(-t / 240.0)) + std::sin(2.0 * pi * (t / 900.0 + phase));
    offset += (constant + walk + white + per_degree * degrees + bend(options, t)) * grid_s;
  }
}

// The reading is linear between the points of the grid. Its inverse `host` is linear too.
double SimulatedClock::reading(double host_s) const {
  const double at = std::clamp(host_s / grid_s, 0.0, static_cast<double>(readings_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), readings_.size() - 2);
  return readings_[i] + (at - static_cast<double>(i)) * (readings_[i + 1] - readings_[i]);
}

double SimulatedClock::host(double reading_s) const {
  const auto behind = std::upper_bound(readings_.begin() + 1, readings_.end() - 1, reading_s);
  const auto i = static_cast<std::size_t>(behind - readings_.begin()) - 1;
  const double share = (reading_s - readings_[i]) / (readings_[i + 1] - readings_[i]);
  return grid_s * (static_cast<double>(i) + share);
}

}  // namespace kinalign
