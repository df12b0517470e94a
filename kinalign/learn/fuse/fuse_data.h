// SPDX-License-Identifier: Apache-2.0
// Sequences to learn fusion from: those of pose_data.h, and what a Kinect before these people says:
// the file's own, or simulated ones (docs/kinect_noise.md).
#pragma once

#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/models/fuse/fuse_features.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

struct FuseData {
  PoseData pose;
  /// Of each sequence of the part with that name, what a Kinect says in the world of its nodes, in
  /// several draws of noise and of the camera's place.
  std::vector<std::vector<JointFrames>> learnt, judged, tested;
};

struct FuseDataOptions {
  std::uint64_t seed = 1;
  std::size_t draws = 2;  // of what is learnt from; else one
  std::string kinect;     // the file's own stream of a Kinect in place of simulated ones
};

/// As pose_data(), and where the file's own Kinect lacks its stream. A simulated one stands 2.2
/// to 3.2 m before the middle of a sequence, within 45 degrees of the person's front.
Result<FuseData> fuse_data(const Windows& windows, const std::string& stream,
                           const std::vector<std::string>& nodes, const FuseDataOptions& options);

/// What a Kinect says of one sequence [T,J], in the world of its nodes.
JointFrames simulated_kinect(const PoseBody& body, const PoseSequence& sequence,
                             std::uint64_t person, std::uint64_t seed, std::uint64_t take);

/// The root's true rotations in the world [T].
std::vector<Eigen::Quaternionf> true_roots(const PoseSequence& sequence);

}  // namespace kinalign
