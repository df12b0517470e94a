// SPDX-License-Identifier: Apache-2.0
// Answers of models to nodes, or to a Kinect and nodes, with the truth of the same take, for
// figures 8, 9 and 10. A child process reads each take and computes the answers.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/models/fuse/fuse_model.h"
#include "kinalign/models/pose/pose_model.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The compared points of a body: first 15 joints by the names of a Kinect, then two points that
/// turn with the head. `compared_joints` relies on this order.
inline constexpr std::array<std::string_view, 17> compared_places{
    "SpineBase",     "SpineShoulder", "Head",       "ShoulderLeft", "ElbowLeft", "WristLeft",
    "ShoulderRight", "ElbowRight",    "WristRight", "HipLeft",      "KneeLeft",  "AnkleLeft",
    "HipRight",      "KneeRight",     "AnkleRight", "Nose",         "Crown"};
inline constexpr std::size_t compared_count = compared_places.size();
inline constexpr std::size_t compared_joints = 15;  // without the two points on the head
/// For each point the index of the point with which a picture joins it; -1: none.
inline constexpr std::array<int, 17> compared_parents{-1, 0, 1,  1, 3,  4,  1, 6, 7,
                                                      0,  9, 10, 0, 12, 13, 2, 2};

/// Positions [frame, point, 3] in m, relative to the middle of the hips, with x to the body's left.
using BodyPlaces = std::vector<float>;

/// Everything that a figure needs of one take. The child process returns it as JSON, so all numbers
/// must be finite.
struct ComparedMotion {
  std::string take;
  double rate_hz = 30.0;
  std::size_t frames = 0;
  // The truth and each answer have the same frames.
  BodyPlaces truth;
  std::vector<BodyPlaces> answers;
  // If answers[0] is a Kinect: the Tracking of each point in each frame.
  std::vector<std::uint8_t> states;
  std::vector<std::uint8_t> hidden;  // for each frame and point: 1 if hidden from the Kinect
};

/// The name and the file of a take with nodes.
struct ComparedTake {
  std::string name, path;
};

/// The answers of all models to the nodes of a take, in the order of `solvers`. All models must
/// have the same frame rate. If a model needs a node on the head, which no take has, that node is
/// simulated from the truth.
Result<ComparedMotion> compare_poses(std::vector<PoseSolver>& solvers, const ComparedTake& take,
                                     Call& call);

/// Four answers: the Kinect's own joints, then the model's answers to the Kinect alone, to the
/// nodes alone and to both. After every 3 s a limb is hidden from the Kinect for 3 s: right arm,
/// left arm, right leg, left leg.
Result<ComparedMotion> compare_devices(Fuser& fuser, const ComparedTake& take, Call& call);

}  // namespace kinalign
