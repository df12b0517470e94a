// SPDX-License-Identifier: Apache-2.0
// A leg of two bones that reaches from the hip to the ankle, computed by the law of cosines.
#pragma once

#include "kinalign/motion/arrays.h"

namespace kinalign {

struct LegBones {
  double thigh = 0.0, shank = 0.0;  // m
};

/// The rotations that move a straight leg so that it ends at the ankle.
struct BentLeg {
  Quat thigh = Quat::Identity(), shank = Quat::Identity();  // global; at rest along -y, facing +z
  double knee = 0.0;  // rad; 0: straight, positive: bent backwards
};

/// `forward`: direction in which the knee points; only its component perpendicular to the leg
/// matters. If the ankle is too far, the leg is straight; if it is too near, the leg is bent as far
/// as possible.
BentLeg reach(const LegBones& bones, const Vec3& hip, const Vec3& ankle, const Vec3& forward);

}  // namespace kinalign
