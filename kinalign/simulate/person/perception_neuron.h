// SPDX-License-Identifier: Apache-2.0
// A body of any size on the skeleton that Perception Neuron suits write: 59 joints and 13 end
// sites, the older («legacy») hierarchy. Its lengths come from a real file of a person of the class
// 1.75 m. Those of the hands are estimates, because none of our sources states them.
#pragma once

#include "kinalign/motion/clip.h"

#include <cstdint>

namespace kinalign {

/// The joints that are used, by their index in the hierarchy.
enum class NeuronJoint : std::size_t {
  hips = 0,
  right_up_leg = 1,
  right_leg = 2,
  right_foot = 3,
  left_up_leg = 4,
  left_leg = 5,
  left_foot = 6,
  spine = 7,
  spine1 = 8,
  spine2 = 9,
  spine3 = 10,
  neck = 11,
  head = 12,
  right_shoulder = 13,
  right_arm = 14,
  right_fore_arm = 15,
  right_hand = 16,
  right_thumb1 = 17,
  left_shoulder = 36,
  left_arm = 37,
  left_fore_arm = 38,
  left_hand = 39,
  left_thumb1 = 40
};
inline constexpr std::size_t neuron_joints = 59;
constexpr std::size_t index(NeuronJoint joint) { return static_cast<std::size_t>(joint); }

/// The rest pose is a T-pose: y up, facing +z, left is +x, palms down, soles at y = 0. `height_m`
/// scales all lengths alike. A `person` other than 0 has individual legs, arms, trunk and widths,
/// which deviate by some percent (sd) from those of the file, with the same height.
/// `person` 0 is the person of the file, scaled.
Skeleton perception_neuron(double height_m, std::uint64_t person);

}  // namespace kinalign
