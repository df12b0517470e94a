// SPDX-License-Identifier: Apache-2.0
// Crops of sequences, as they are or as another person would have moved: the mirror image, faster
// or slower, taller or smaller.
#pragma once

#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/models/joint_frames.h"
#include "kinalign/simulate/random.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// How far crops are varied.
struct Variety {
  double mirrored = 0.5;  // share of crops
  double speed = 0.0;     // a crop is faster or slower by up to this share
  double size = 0.0;      // a body and its way are larger or smaller by up to this share
};

inline constexpr Variety no_variety{.mirrored = 0.0, .speed = 0.0, .size = 0.0};

struct Variation {
  bool mirrored = false;
  double speed = 1.0, size = 1.0;
};

Variation draw_variation(const Variety& variety, const RandomStream& random);

/// `count` frames from frame `begin` on. The last frame is repeated where the sequence ends sooner.
struct Crop {
  std::size_t begin = 0, count = 0;
  Variation variation{};

  /// Frames of the sequence that it covers.
  std::size_t source_frames() const;
};

/// Left and right of a body: for each node, bone and joint the one on the other side.
struct Sides {
  std::vector<std::size_t> nodes, bones, joints, kinect;
  /// No node is alone on its side. Other crops are never mirrored.
  bool can_mirror = true;

  Sides(const PoseBody& body, const std::vector<std::string>& node_names,
        const std::vector<std::string>& kinect_names);
};

/// In `crop`'s time, size and mirror. Between two frames rotations and vectors are interpolated;
/// a sample or joint is there where it is in both of them.
NodeFrames crop_of(const NodeFrames& nodes, const Crop& crop, const Sides& sides);
JointFrames crop_of(const JointFrames& kinect, const Crop& crop, const Sides& sides);
/// Nodes, rotations, places and the person's rest offsets.
PoseSequence crop_of(const PoseSequence& sequence, const Crop& crop, const Sides& sides);

}  // namespace kinalign
