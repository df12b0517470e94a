// SPDX-License-Identifier: Apache-2.0
// Root and heading of a body, found from the input device alone, because no ground truth exists
// when a model is used. The heading follows Holden: hips and shoulders define it.
#pragma once

#include "kinalign/models/joint_frames.h"
#include "kinalign/models/smoothing.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The joints that define the body's frame. If the root has several joints, their positions are
/// averaged.
struct BodyJoints {
  std::vector<std::size_t> root;                       // SpineBase, or both hips
  std::vector<std::array<std::size_t, 2>> left_right;  // hips, shoulders
};

/// Finds these joints by the names of a Kinect, of usual mocap skeletons or of CMU. Empty if the
/// names contain no root or no left/right pair.
std::optional<BodyJoints> body_joints(const std::vector<std::string>& names);

/// A space that moves with the body: origin at its root, y up, x to its left. Networks work in this
/// space, so they need not learn every position and every direction that a person can face. The
/// vertical stays the world's.
struct BodyFrame {
  std::array<float, 3> root{};       // m
  float cosine = 1.0F, sine = 0.0F;  // the heading; (cosine, 0, sine) points to the body's left

  std::array<float, 3> turned(const float* vector) const;       // from the world's space
  std::array<float, 3> turned_back(const float* vector) const;  // to the world's space
};

/// One frame for each of T rows of smoothed joints. If the summed left-right distance of hips and
/// shoulders in the floor plane is below 15 cm (a body seen from the side), the last heading is
/// kept.
std::vector<BodyFrame> body_frames(const BodyJoints& joints, const JointFrames& smoothed);

/// Fills missing joints from neighbouring frames: linear interpolation between the last and the
/// next frame in which the joint was seen, constant at both ends. If `causal`, the last seen
/// position is repeated until the joint is seen again. A joint that was never seen gets the mean of
/// the seen joints.
void fill_missing(JointFrames& body, bool causal);

}  // namespace kinalign
