// SPDX-License-Identifier: Apache-2.0
// How far a pose is off. Rotations and positions are those against the root, so neither the place
// nor the heading of a person counts.
#pragma once

#include "kinalign/models/pose/pose_body.h"

#include <cstddef>
#include <span>

namespace kinalign {

/// Means over all frames.
struct PoseErrors {
  double sip_deg = 0.0;      // global rotation of thighs and upper arms
  double angle_deg = 0.0;    // global rotation of all bones but neck and head
  double head_deg = 0.0;     // of neck and head
  double position_cm = 0.0;  // of the joints below hips, chest and shoulders, these included
  double jitter = 0.0;       // m/s3, third difference of these joints; of the answer
  double true_jitter = 0.0;  // of the truth
  std::size_t frames = 0;

  double jitter_ratio() const { return true_jitter > 0.0 ? jitter / true_jitter : 0.0; }
  /// Joins means, weighted by frames.
  void add(const PoseErrors& more);
};

/// A person's true pose, to be compared with.
struct TruePose {
  std::span<const Turn> rotations;     // [T,B]
  std::span<const Vec3> rest_offsets;  // [J], for the answer too
};

/// `answer` [T,B]. Groups of bones and joints go by the names of pose_body.h.
PoseErrors pose_errors(const PoseBody& body, std::span<const Turn> answer, const TruePose& truth,
                       double rate_hz);

/// Whether position errors count this joint. Root, hips, lower back, lower neck and clavicles stay
/// nearly at their places against the root, whatever is answered. Toes and fingers are only
/// guessed.
bool is_scored_joint(std::string_view name);

}  // namespace kinalign
