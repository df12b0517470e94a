// SPDX-License-Identifier: Apache-2.0
// Sequences to learn poses from: motion capture in a file of windows, with the samples that nodes
// on these people would have given.
#pragma once

#include "kinalign/models/pose/pose_body.h"
#include "kinalign/models/pose/pose_features.h"
#include "kinalign/models/windows_file.h"

#include <string>
#include <vector>

namespace kinalign {

/// A stretch of T frames at 30 Hz. Each person's rotations begin at an upright stand
/// (upright_zero.h).
struct PoseSequence {
  std::string subject, action;
  NodeFrames nodes;                // without errors
  std::vector<Turn> rotations;     // [T,B] global, against the root
  std::vector<Vec3> places;        // [T] m, of the root in the world
  std::vector<Vec3> rest_offsets;  // [J] m, the person's own
  /// Where it comes from: frame t is row first_row + t rows_a_frame of this stretch of the file.
  std::size_t stretch = 0, first_row = 0, rows_a_frame = 1;

  std::size_t frames() const { return nodes.frames(); }
};

struct PoseData {
  std::vector<std::string> nodes;  // [N] the last one is the root's
  PoseBody body;                   // the mean of the people who are learnt from
  double rate_hz = 30.0;
  /// Sequences of the parts train, validation and all others. If the file has one part alone, its
  /// sequences are learnt from.
  std::vector<PoseSequence> learnt, judged, tested;
  std::vector<std::string> left_out;  // people who never stand upright for 60 frames
};

/// Names of all places for nodes: waist, wrist_left, wrist_right, ankle_left, ankle_right, head.
std::vector<std::string> known_pose_nodes();
/// The paper's five nodes, the root last.
std::vector<std::string> usual_pose_nodes();

/// `stream`: a skeleton with CMU's joints or a suit's (pose_skeleton.h), at a multiple of 30 Hz.
/// `nodes`: 3 to 6 that are known, the root ("waist") last. Stretches shorter than 1.5 s are left
/// out. Fails where the stream, its arrays or a joint are missing and where nothing is left to
/// learn from.
Result<PoseData> pose_data(const Windows& windows, const std::string& stream,
                           const std::vector<std::string>& nodes);

}  // namespace kinalign
