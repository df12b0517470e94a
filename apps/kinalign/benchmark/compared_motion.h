// SPDX-License-Identifier: Apache-2.0
// Answers to nodes, or to a Kinect and nodes, together with the truth of the same take: figures 8,
// 9 and 10. Each take is read and answered in a child process.
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

/// The compared places of a body: joints by a Kinect's names, then two places that turn with the
/// head.
/// The order is fixed: places 0 to 14 are joints, so `compared_joints` counts them, and both places
/// of the head come last.
inline constexpr std::array<std::string_view, 17> compared_places{
    "SpineBase",     "SpineShoulder", "Head",       "ShoulderLeft", "ElbowLeft", "WristLeft",
    "ShoulderRight", "ElbowRight",    "WristRight", "HipLeft",      "KneeLeft",  "AnkleLeft",
    "HipRight",      "KneeRight",     "AnkleRight", "Nose",         "Crown"};
inline constexpr std::size_t compared_count = compared_places.size();
inline constexpr std::size_t compared_joints = 15;  // without the two places on the head
/// The place that each place is joined to in a picture; -1: none.
inline constexpr std::array<int, 17> compared_parents{-1, 0, 1,  1, 3,  4,  1, 6, 7,
                                                      0,  9, 10, 0, 12, 13, 2, 2};

/// Places [T,17,3] m relative to the middle of the hips, turned so that x is the body's left.
using BodyPlaces = std::vector<float>;

/// All that a figure needs of one take. It crosses the border between two processes as JSON, so its
/// numbers must be finite.
struct ComparedMotion {
  std::string take;
  double rate_hz = 30.0;
  std::size_t frames = 0;
  // [T,17,3] m; every member of `answers` has the same shape and grid of stamps.
  BodyPlaces truth;
  std::vector<BodyPlaces> answers;
  std::vector<std::uint8_t> states;  // [T,17] Tracking of answers[0] if that is a Kinect
  std::vector<std::uint8_t> hidden;  // [T,17] 1: hidden from the Kinect
};

/// A take with nodes: its name and its file.
struct ComparedTake {
  std::string name, path;
};

/// The answers of all models to the take's nodes. The take has no node on the head, so a model that
/// needs one gets one computed from the truth.
/// The models must have one rate. The order of the answers is that of `solvers`.
Result<ComparedMotion> compare_poses(std::vector<PoseSolver>& solvers, const ComparedTake& take,
                                     Call& call);

/// The answers: the Kinect's own joints, then the model's to the Kinect alone, to the nodes alone
/// and to both. From second 3 on every second stretch of 3 s hides a limb from the Kinect: right
/// arm, left arm, right leg, left leg.
Result<ComparedMotion> compare_devices(Fuser& fuser, const ComparedTake& take, Call& call);

}  // namespace kinalign
