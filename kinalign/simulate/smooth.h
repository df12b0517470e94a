// SPDX-License-Identifier: Apache-2.0
// Curves from which movements are composed. They are at least three times continuously
// differentiable, so the readings of a simulated accelerometer and their slope have no jumps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kinalign {

/// Rises from 0 at x = 0 to 1 at x = 1, three times continuously differentiable. The slope is
/// steepest in the middle, 35/16.
inline double rise(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * x * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)));
}

/// 1 at x = 0.5, 0 outside [0, 1]; three times continuously differentiable.
inline double bump(double x) {
  x = std::clamp(x, 0.0, 1.0);
  const double y = 4.0 * x * (1.0 - x);
  return y * y * y * y;
}

/// Rises from 0 to 1, like a body that accelerates for 0.42 of the time, keeps its speed, and slows
/// down. Four times continuously differentiable; the slope is at most 1.72.
inline double glide(double x) {
  constexpr double ramp = 0.42, speed = 1.0 / (1.0 - ramp);
  x = std::clamp(x, 0.0, 1.0);
  if (x > 0.5) return 1.0 - glide(1.0 - x);
  if (x >= ramp) return speed * (x - 0.5 * ramp);
  const double u = x / ramp;  // the polynomial below is the integral of rise()
  return speed * ramp * u * u * u * u * u * (7.0 + u * (-14.0 + u * (10.0 - 2.5 * u)));
}

/// A smooth minimum. If the two values differ by much more than `width`, it equals the smaller
/// value. If they are equal, it is half of `width` below them. Differentiable any number of times.
inline double soft_min(double a, double b, double width) {
  return 0.5 * (a + b - std::sqrt((a - b) * (a - b) + width * width));
}

/// A curve through the neighbourhood of control values at equal steps: a uniform B-spline of degree
/// 5. It is four times continuously differentiable and stays within the range of the control
/// values. Outside the controls it keeps the nearest value.
class ControlTrack {
 public:
  ControlTrack(double step_s, std::vector<double> controls)
      : step_s_(step_s), controls_(std::move(controls)) {}

  double at(double t) const {
    // The spline is centred: at t = k step, control k has the greatest of the six weights.
    const double x = t / step_s_;
    const double floor = std::floor(x), u = x - floor;
    const auto first = static_cast<std::ptrdiff_t>(std::clamp(floor, -1e9, 1e9)) - 2;
    double sum = 0.0;
    for (int k = 0; k < 6; ++k)
      sum += weight(static_cast<double>(k) - 2.0 - u) * control(first + k);
    return sum;
  }

 private:
  /// The cardinal B-spline of degree 5, centred at 0, with half-width 3.
  static double weight(double x) {
    const auto fifth = [](double y) { return y > 0.0 ? y * y * y * y * y : 0.0; };
    const double a = std::abs(x);
    return (fifth(3.0 - a) - 6.0 * fifth(2.0 - a) + 15.0 * fifth(1.0 - a)) / 120.0;
  }
  double control(std::ptrdiff_t k) const {
    const auto last = static_cast<std::ptrdiff_t>(controls_.size()) - 1;
    return controls_[static_cast<std::size_t>(std::clamp(k, std::ptrdiff_t{0}, last))];
  }

  double step_s_;
  std::vector<double> controls_;
};

}  // namespace kinalign
