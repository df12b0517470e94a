// SPDX-License-Identifier: Apache-2.0
// The counter of a node. Its crystal has a constant error, drifts, warms up and is noisy. All times
// are in seconds on the host's time axis, which is taken as true. An uncompensated crystal has an
// error of at most 20 ppm (table 1 of «Time synchronisation for millisecond-precision on
// bio-loggers», Movement Ecology 2024). Estimates are 0.3 ppm per degree and warming by 12 degrees
// in some minutes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

struct NodeClockOptions {
  std::optional<double> frequency_error;  // 1e-6: 1 ppm fast; absent: drawn, up to 20 ppm
  bool temperature = true;                // the node warms up from the beginning
  double ramp = 0.0;                      // additional change of the frequency error, 1/s
  double curvature = 0.0;                 // greatest change of an additional sine, 1/s
  double period_s = 20.0;                 // period of that sine
};

/// The reading is n(t) = 5 s + t + X(t), on a grid of 0.1 s with linear interpolation. X' is the
/// sum of the constant error, a random walk (1e-9 per root second), white noise (Allan deviation
/// 1e-9 at 1 s) and the effect of temperature. The constructor draws the whole curve. reading()
/// limits times to the curve's range.
class SimulatedClock {
 public:
  SimulatedClock(std::uint64_t seed, double length_s, const NodeClockOptions& options = {});

  /// reading(): reading of the node's crystal at host time t, s. host(): the inverse.
  double reading(double host_s) const;
  double host(double reading_s) const;

 private:
  std::vector<double> readings_;  // s, on the grid
};

}  // namespace kinalign
