// SPDX-License-Identifier: Apache-2.0
// A body of any size with the skeleton of Perception Neuron suits: 59 joints and 13 end sites, the
// older («legacy») hierarchy. The lengths come from a real file of a person of 1.75 m. The lengths
// of the hands are estimates, because no source states them.
#pragma once

#include "kinalign/motion/clip.h"

#include <cstdint>

namespace kinalign {

/// The joints that the simulation uses, by their index in the hierarchy.
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

/// Returns the skeleton. The rest pose is a T-pose: y up, facing +z, +x to the left, palms down,
/// soles at y = 0. `height_m` scales all lengths. `person` 0 is the person of the file. Other
/// values of `person` give individual legs, arms, trunk and widths of the same height, which
/// deviate from the file by some percent.
Skeleton perception_neuron(double height_m, std::uint64_t person);

}  // namespace kinalign
