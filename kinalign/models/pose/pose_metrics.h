// SPDX-License-Identifier: Apache-2.0
// Error measures of a pose. Rotations and positions are relative to the root, so the person's
// position and heading do not count.
#pragma once

#include "kinalign/models/pose/pose_body.h"

#include <cstddef>
#include <span>

namespace kinalign {

/// Mean errors over all frames.
struct PoseErrors {
  double sip_deg = 0.0;    // rotation error of thighs and upper arms
  double angle_deg = 0.0;  // rotation error of all bones but neck and head
  double head_deg = 0.0;   // rotation error of neck and head
  /// Position error of the joints for which is_scored_joint() is true.
  double position_cm = 0.0;
  double jitter = 0.0;       // m/s3, mean third difference of these joints in the estimated pose
  double true_jitter = 0.0;  // m/s3, mean third difference in the true pose
  std::size_t frames = 0;

  double jitter_ratio() const { return true_jitter > 0.0 ? jitter / true_jitter : 0.0; }
  /// Combines two means, weighted by their numbers of frames.
  void add(const PoseErrors& more);
};

/// The ground truth of a pose.
struct TruePose {
  std::span<const Turn> rotations;     // [T,B] of each bone in each frame
  std::span<const Vec3> rest_offsets;  // [J] m, used for the answer too
};

/// `answer` [T,B]. Groups of bones and joints are chosen by the names of pose_body.h.
PoseErrors pose_errors(const PoseBody& body, std::span<const Turn> answer, const TruePose& truth,
                       double rate_hz);

/// True if position errors count this joint. Root, hips, lower back, lower neck and clavicles are
/// left out because they hardly move relative to the root. Toes and fingers are left out because
/// they are only guessed.
bool is_scored_joint(std::string_view name);

}  // namespace kinalign
