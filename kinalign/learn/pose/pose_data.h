// SPDX-License-Identifier: Apache-2.0
// Sequences to learn poses from: motion capture from a file of windows, with simulated samples of
// nodes on these people.
#pragma once

#include "kinalign/models/pose/pose_body.h"
#include "kinalign/models/pose/pose_features.h"
#include "kinalign/models/windows_file.h"

#include <string>
#include <vector>

namespace kinalign {

/// A stretch of T frames at 30 Hz. Rotations are relative to each person's upright stand
/// (upright_zero.h). The nodes have no errors here. Each training crop gets new random errors
/// (node_errors.h).
struct PoseSequence {
  std::string subject, action;
  NodeFrames nodes;                // [T,N] without errors
  std::vector<Turn> rotations;     // [T,B] global, relative to the root
  std::vector<Vec3> places;        // [T] m, position of the root in the world
  std::vector<Vec3> rest_offsets;  // [J] m, the person's own
  /// The source: frame t is row first_row + t * rows_a_frame of this stretch of the file.
  std::size_t stretch = 0, first_row = 0, rows_a_frame = 1;

  std::size_t frames() const { return nodes.frames(); }
};

/// All data for training on poses, in memory. PoseTask keeps a reference to it.
struct PoseData {
  std::vector<std::string> nodes;  // [N] the last one is the root's
  PoseBody body;                   // mean body of the training people
  double rate_hz = 30.0;
  /// Sequences of the parts train, validation, and all others. If the file has a single part, its
  /// sequences are used for training.
  std::vector<PoseSequence> learnt, judged, tested;
  std::vector<std::string> left_out;  // people with fewer than 60 upright frames
};

/// Names of all known places: waist, wrist_left, wrist_right, ankle_left, ankle_right, head.
std::vector<std::string> known_pose_nodes();
/// The five nodes of the HFUT-MMD paper (README.md); the root is the last one.
std::vector<std::string> usual_pose_nodes();

/// Reads sequences. `stream`: a skeleton with CMU's joints or those of a suit (pose_skeleton.h), at
/// a multiple of 30 Hz. `nodes`: 3 to 6 known names, the root ("waist") last. Stretches shorter
/// than 1.5 s are left out. Fails if the stream, its arrays or a joint is missing, or if no
/// training data remain.
Result<PoseData> pose_data(const Windows& windows, const std::string& stream,
                           const std::vector<std::string>& nodes);

}  // namespace kinalign
