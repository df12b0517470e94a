// SPDX-License-Identifier: Apache-2.0
// Crops of sequences, unchanged or as another person would have moved: mirrored, faster or slower,
// taller or smaller.
#pragma once

#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/models/joint_frames.h"
#include "kinalign/simulate/random.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// Limits of the random variation of crops (augmentation), the same for input and truth. Speed and
/// size are not varied by default (docs/training.md).
struct Variety {
  double mirrored = 0.5;  // share of mirrored crops
  double speed = 0.0;     // a crop is at most this share faster or slower
  double size = 0.0;      // body and path are at most this share larger or smaller
};

inline constexpr Variety no_variety{.mirrored = 0.0, .speed = 0.0, .size = 0.0};

/// One random draw within a Variety: factors of speed and size, 1 for no change.
struct Variation {
  bool mirrored = false;
  double speed = 1.0, size = 1.0;
};

Variation draw_variation(const Variety& variety, const RandomStream& random);

/// `count` frames from frame `begin` on. If the sequence is too short, its last frame is repeated.
struct Crop {
  std::size_t begin = 0, count = 0;
  Variation variation{};

  /// Number of frames of the sequence that the crop covers.
  std::size_t source_frames() const;
};

/// For each node, bone and joint the index of its counterpart on the other side of the body, found
/// by names once for all crops.
struct Sides {
  std::vector<std::size_t> nodes, bones, joints, kinect;
  /// True if each node on one side has a counterpart on the other; else crops are never mirrored.
  bool can_mirror = true;

  Sides(const PoseBody& body, const std::vector<std::string>& node_names,
        const std::vector<std::string>& kinect_names);
};

/// The crop, with its speed, size and mirroring applied. Rotations and vectors are interpolated
/// between two frames; a sample or joint is valid if it is valid in both of these frames.
NodeFrames crop_of(const NodeFrames& nodes, const Crop& crop, const Sides& sides);
JointFrames crop_of(const JointFrames& kinect, const Crop& crop, const Sides& sides);
/// Crops nodes, rotations, positions and the person's rest offsets. Truth and input get the same
/// variation.
PoseSequence crop_of(const PoseSequence& sequence, const Crop& crop, const Sides& sides);

}  // namespace kinalign
