// SPDX-License-Identifier: Apache-2.0
// A leg of two bones that reaches from the hip to the ankle, by the law of cosines.
#pragma once

#include "kinalign/motion/arrays.h"

namespace kinalign {

struct LegBones {
  double thigh = 0.0, shank = 0.0;  // m
};

struct BentLeg {
  Quat thigh = Quat::Identity(), shank = Quat::Identity();  // global; at rest along -y, facing +z
  double knee = 0.0;                                        // rad, 0 straight, bent backwards above
};

/// `forward`: where the knee points, across the leg as far as it is not. An ankle that is out of
/// reach is reached for: straight, or bent as far as the bones allow.
BentLeg reach(const LegBones& bones, const Vec3& hip, const Vec3& ankle, const Vec3& forward);

}  // namespace kinalign
