// SPDX-License-Identifier: Apache-2.0
// Root and heading of a body, from what the input device saw alone: at use there is no truth.
// Source: Holden's heading from hips and shoulders, applied to the input.
#pragma once

#include "kinalign/models/joint_frames.h"
#include "kinalign/models/smoothing.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Which joints the frame is found from. Positions of several are averaged.
struct BodyJoints {
  std::vector<std::size_t> root;                       // SpineBase, or both hips
  std::vector<std::array<std::size_t, 2>> left_right;  // hips, shoulders
};

/// By the names of a Kinect, of usual mocap skeletons, of CMU; none where no pair of sides or no
/// root is there.
std::optional<BodyJoints> body_joints(const std::vector<std::string>& names);

/// A space that goes along with the body: origin at its root, y up, x to its left.
struct BodyFrame {
  std::array<float, 3> root{};       // m
  float cosine = 1.0F, sine = 0.0F;  // of the heading: (cosine, 0, sine) is the body's left

  std::array<float, 3> turned(const float* vector) const;       // from the world's
  std::array<float, 3> turned_back(const float* vector) const;  // to the world's
};

/// A frame for each of T rows of smoothed joints. Where hips and shoulders lie within 15 cm of a
/// line (a body seen from the side), the heading stays what it was.
std::vector<BodyFrame> body_frames(const BodyJoints& joints, const JointFrames& smoothed);

/// Missing joints from the frames around: on the line between the last and the next seen, held at
/// the ends and, if `causal`, until it is seen again. One never seen lies at the mean of the
/// others.
void fill_missing(JointFrames& body, bool causal);

}  // namespace kinalign
