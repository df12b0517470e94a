// SPDX-License-Identifier: Apache-2.0
// The counter of a node whose crystal is a little off, ages, warms up and is noisy. All times in
// seconds; the axis of truth is the host's. Constants: an uncompensated crystal at most 20 ppm off
// (table 1 of «Time synchronisation for millisecond-precision on bio-loggers», Movement Ecology
// 2024); 0.3 ppm per degree and 12 degrees of warming in some minutes are estimates.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

struct NodeClockOptions {
  std::optional<double> frequency_error;  // 1e-6: 1 ppm fast; absent: drawn, up to 20 ppm
  bool temperature = true;                // warms up from the first second
  double ramp = 0.0;                      // added change of the frequency error, per second
  double curvature = 0.0;                 // of an added sine: its greatest change, per second …
  double period_s = 20.0;                 // … and its period
};

/// Reading n(t) = 5 s + t + X(t) on a grid of 0.1 s, linear in between. X' is the constant error, a
/// random walk (1e-9 per root second), white noise (Allan deviation 1e-9 at 1 s) and temperature.
class SimulatedClock {
 public:
  SimulatedClock(std::uint64_t seed, double length_s, const NodeClockOptions& options = {});

  /// What the node's crystal has counted at host time t, s; and when it had counted n.
  double reading(double host_s) const;
  double host(double reading_s) const;

 private:
  std::vector<double> readings_;  // s, at multiples of the grid's step
};

}  // namespace kinalign
