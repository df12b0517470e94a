// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/leg.h"

#include "kinalign/motion/rotation.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

// In the law of cosines, two sides are the bones and the third is the distance from hip to ankle.
// The thigh is rotated forwards by the angle at the hip, the shank backwards by the angle at the
// knee.
BentLeg reach(const LegBones& bones, const Vec3& hip, const Vec3& ankle, const Vec3& forward) {
  const double a = bones.thigh, b = bones.shank;
  const Vec3 way = ankle - hip;
  const double d = std::clamp(way.norm(), std::abs(a - b) + 1e-6 * a, a + b);
  const Vec3 up = -way.normalized();
  const Vec3 front = (forward - forward.dot(up) * up).normalized();
  Eigen::Matrix3d axes;
  axes << up.cross(front), up, front;
  const auto corner = [](double adjacent, double other, double opposite) {
    const double cosine =
        (adjacent * adjacent + other * other - opposite * opposite) / (2.0 * adjacent * other);
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  };
  const double at_hip = corner(a, d, b), at_ankle = corner(b, d, a);
  BentLeg leg;
  leg.knee = at_hip + at_ankle;
  leg.thigh = Quat(axes) * rotation(Vec3(-at_hip, 0, 0));
  leg.shank = leg.thigh * rotation(Vec3(leg.knee, 0, 0));
  return leg;
}

}  // namespace kinalign
