// SPDX-License-Identifier: Apache-2.0
// Sequences to learn fusion from: those of pose_data.h with the data of a Kinect in front of these
// people. The Kinect is the file's own stream or simulated (docs/kinect_noise.md).
#pragma once

#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/models/fuse/fuse_features.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// Sequences of people with nodes (`pose`) and the Kinect's joints for them. Simulating a Kinect
/// takes longer than cutting a crop. The Kinects are therefore simulated once, and each crop
/// chooses one of them.
struct FuseData {
  PoseData pose;
  /// For each sequence of the part with that name: the Kinect's joints in the world of the nodes,
  /// for several draws of noise and camera place.
  std::vector<std::vector<JointFrames>> learnt, judged, tested;
};

struct FuseDataOptions {
  std::uint64_t seed = 1;
  std::size_t draws = 2;  // draws for each training sequence; other sequences have one
  std::string kinect;     // name of the file's Kinect stream; empty: simulate
};

/// Reads sequences like pose_data(). Also fails if options.kinect names a stream that is absent. A
/// simulated Kinect stands 2.2 to 3.2 m from the middle of a sequence, within 45 degrees of the
/// person's front.
Result<FuseData> fuse_data(const Windows& windows, const std::string& stream,
                           const std::vector<std::string>& nodes, const FuseDataOptions& options);

/// The simulated Kinect's joints [T,J] for one sequence, in the world of its nodes.
/// `person`, `seed` and `take` choose the noise: a person keeps the same systematic errors in all
/// takes.
JointFrames simulated_kinect(const PoseBody& body, const PoseSequence& sequence,
                             std::uint64_t person, std::uint64_t seed, std::uint64_t take);

/// The true rotations of the root in the world [T].
std::vector<Eigen::Quaternionf> true_roots(const PoseSequence& sequence);

}  // namespace kinalign
