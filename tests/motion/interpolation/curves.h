// SPDX-License-Identifier: Apache-2.0
// Curves through values and rotations as functions of plain arrays, for tests.
#pragma once

#include "kinalign/motion/interpolation/rotation_spline.h"
#include "kinalign/motion/interpolation/slerp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace kinalign {

using Values = std::vector<double>;

/// Slerp of the knots [T,4] at times [T] to rotations [N,4] at the given places [N].
inline Values slerp(const Values& times, const Values& knots, const Values& at) {
  Values out(4 * at.size(), -7.0);
  slerp_at(times, knots, at, out);
  return out;
}

inline Values rotation_spline(const Values& times, const Values& knots, const Values& at) {
  Values out(4 * at.size(), -7.0);
  const RotationKnots all{times, knots};
  rotation_spline_at(all, at, out);
  return out;
}

inline Values random_values(std::size_t n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Values values(n);
  for (double& v : values) v = normal(random);
  return values;
}

/// NaN if a value is NaN or sizes differ, so that any limit fails.
inline double worst_difference(const Values& a, const Values& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size() && a.size() == b.size(); ++i) {
    if (std::isnan(a[i] - b[i])) return a[i] - b[i];
    worst = std::max(worst, std::abs(a[i] - b[i]));
  }
  return a.size() == b.size() ? worst : std::numeric_limits<double>::quiet_NaN();
}

/// The values with a change made to each.
template <class Change>
Values each(Values values, Change&& change) {
  for (double& v : values) v = change(v);
  return values;
}

}  // namespace kinalign
