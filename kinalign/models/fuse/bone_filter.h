// SPDX-License-Identifier: Apache-2.0
// Fuses Kinect and nodes without learning: each bone's rotation is estimated from the devices that
// measure it. A node measures a whole rotation. The direction of the bone in the Kinect then turns
// that rotation along the shortest way, weighted by the uncertainty of both. If the two differ by
// more than the option `gate`, the direction is ignored. A bone without a node starts from its
// parent's rotation and follows the Kinect's direction. A bone that no device measures keeps its
// last rotation relative to its parent. docs/fuse.md calls this method «filter».
#pragma once

#include "kinalign/models/fuse/node_headings.h"
#include "kinalign/models/smoothing.h"

#include <vector>

namespace kinalign {

/// A person's pose in the world.
struct FusedPose {
  std::vector<Turn> rotations;           // [T,B] relative to the root
  std::vector<Eigen::Quaternionf> root;  // [T] orientation in the world
  std::vector<Eigen::Vector3f> place;    // [T] m, position of the root in the world
};

struct BoneFilterOptions {
  double node_deg = 4.0;  // spread of a node's rotation, 1 sigma
  /// Spread of a direction seen by the Kinect, 1 sigma.
  double tracked_deg = 6.0, inferred_deg = 25.0;
  double gate = 3.0;                  // sigma; a larger difference is ignored
  Smoothing smoothing{.window = 11};  // smoothing of the Kinect's joints
};

/// `input`: nodes with corrected headings (node_headings.h), or one device alone.
FusedPose filtered_pose(const FuseLayout& layout, const PoseBody& body, const FuseInput& input,
                        const BoneFilterOptions& options = {});

}  // namespace kinalign
