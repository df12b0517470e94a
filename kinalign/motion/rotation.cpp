// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/rotation.h"

namespace kinalign {

Vec3 rotation_vector(const Quat& q) {
  const Vec3 v = q.vec();
  return rotation_vector_factor(q.w(), v.squaredNorm()) * v;
}

Quat rotation(const Vec3& vector) {
  Vec3 r = vector;
  int halvings = 0;
  // Above 1e9 rad a double can't represent the direction of a rotation; 40 halvings suffice up to
  // there.
  // Half of the rotation vector is a rotation by half the angle; squaring it doubles the angle
  // again.
  for (; !(r.squaredNorm() <= most_rotation_parts) && halvings < 40; ++halvings) r *= 0.5;
  const RotationParts parts = rotation_parts(r.squaredNorm());
  const Vec3 v = parts.vector * r;
  Quat q(parts.w, v.x(), v.y(), v.z());
  for (; halvings > 0; --halvings) q = (q * q).normalized();
  return q;
}

}  // namespace kinalign
