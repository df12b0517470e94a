// SPDX-License-Identifier: Apache-2.0
// Rotations for tests: awkward ones, random ones, random walks; and the angle between two.
#pragma once

#include "kinalign/motion/arrays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace kinalign {

/// The angle between two rotations, rad; accurate where it is small.
inline double angle_between(const Quat& a, const Quat& b) {
  const Quat apart = a.conjugate() * b;
  return 2.0 * std::atan2(apart.vec().norm(), std::abs(apart.w()));
}

/// NaN if one of them is NaN, so that any limit fails.
inline double worst_angle(std::span<const double> a, std::span<const double> b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size() / 4; ++i) {
    const double angle = angle_between(quat(a, i), quat(b, i));
    if (std::isnan(angle)) return angle;
    worst = std::max(worst, angle);
  }
  return worst;
}

inline Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

inline Quat random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
}

/// Rotation vectors at which formulas fail: zero, tiny, near and at half a turn, several turns.
inline std::vector<Vec3> awkward_vectors() {
  using std::numbers::pi;
  std::vector<Vec3> all{Vec3::Zero()};
  for (const double angle : {1e-300, 1e-160, 1e-9, 1e-5, 0.1, 1.0, pi / 2, pi - 1e-5, pi - 1e-9, pi,
                             pi + 1e-9, 2 * pi - 1e-9, 2 * pi, 7.0, 3 * pi, 20.0}) {
    all.push_back(angle * Vec3::UnitX());
    all.push_back(-angle * Vec3::UnitY());
    all.push_back(angle * Vec3(0.48, -0.6, 0.64));
  }
  return all;
}

/// Stamps 1/30 s apart give or take 12 ms.
inline std::vector<double> jittery_stamps(std::size_t n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> t(n);
  for (std::size_t i = 0; i < n; ++i) {
    t[i] = static_cast<double>(i) / 30.0 + 0.004 * std::clamp(normal(random), -3.0, 3.0);
  }
  return t;
}

/// Stamps with steps from 5 to 200 ms.
inline std::vector<double> irregular_stamps(std::size_t n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> step(0.005, 0.2);
  std::vector<double> t(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) t[i] = t[i - 1] + step(random);
  return t;
}

/// About `n` rising places in [t.front(), t.back()], including both ends and all knots.
inline std::vector<double> places_within(const std::vector<double>& t, std::size_t n,
                                         std::mt19937_64& random) {
  std::uniform_real_distribution<double> anywhere(t.front(), t.back());
  std::vector<double> at = t;
  if (t.size() > 1) {
    for (std::size_t i = 0; i < n; ++i) at.push_back(anywhere(random));
  }
  std::sort(at.begin(), at.end());
  return at;
}

/// [n,4] rotations, each up to `most` rad from the one before about a random axis, with random
/// signs.
inline std::vector<double> rotation_walk(std::size_t n, double most, std::mt19937_64& random) {
  std::uniform_real_distribution<double> angle(0.0, most);
  std::vector<double> out(4 * n);
  Quat q = random_rotation(random);
  for (std::size_t i = 0; i < n; ++i) {
    const double sign = random() % 2 == 0 ? 1.0 : -1.0;
    put_quat(out, i, Quat(sign * q.coeffs()));
    q = (q * Eigen::AngleAxisd(angle(random), random_direction(random))).normalized();
  }
  return out;
}

/// [n,4] rotations that swing smoothly by about a radian at up to 1 Hz.
inline std::vector<double> smooth_rotations(const std::vector<double>& t) {
  std::vector<double> out(4 * t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Vec3 v(1.2 * std::sin(3 * t[i]), 0.8 * std::cos(2 * t[i]), 0.5 * std::sin(5 * t[i] + 1));
    put_quat(out, i, Quat(Eigen::AngleAxisd(v.norm(), v.normalized())));
  }
  return out;
}

}  // namespace kinalign
