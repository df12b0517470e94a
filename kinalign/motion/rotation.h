// SPDX-License-Identifier: Apache-2.0
// Converts rotations to and from rotation vectors (axis times angle, rad).
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/motion/trigonometry.h"

#include <cmath>

namespace kinalign {

/// The factor F such that the rotation vector of the unit quaternion w + v is F * v, at most pi
/// long. q and -q are the same rotation and give the same vector. v2 = |v|^2.
KA_INLINE double rotation_vector_factor(double w, double v2) {
  // With t = tan(angle / 4) = |v| / (1 + |w|): angle * v / |v| = 4 atan(t) / t * v / (1 + |w|).
  const double below = 1.0 / (1.0 + std::abs(w));
  return std::copysign(4.0 * arctangent_ratio(v2 * below * below) * below, w);
}

/// The square of the longest rotation vector that rotation_parts accepts: (2 pi)^2.
constexpr double most_rotation_parts = 39.478417604357434;

/// The unit quaternion of a rotation vector r, at most 2 pi long, is w + vector * r. r2 = |r|^2.
struct RotationParts {
  double w, vector;
};
KA_INLINE RotationParts rotation_parts(double r2) {
  // Computes sine and cosine of half the angle from those of its quarter z, for which the series
  // are short.
  const double z2 = r2 * 0.0625, ratio = sine_ratio(z2);
  return {1.0 - 2.0 * z2 * ratio * ratio, 0.5 * ratio * cosine(z2)};
}

/// The rotation vector of a unit quaternion, at most pi long, exact to 1e-15.
Vec3 rotation_vector(const Quat& q);

/// The unit quaternion of a rotation vector of any length, exact to 1e-15 up to two turns.
Quat rotation(const Vec3& vector);

}  // namespace kinalign
