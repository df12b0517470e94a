// SPDX-License-Identifier: Apache-2.0
// Kinect and nodes joined without learning: each bone's rotation from what shows it. A node gives a
// whole rotation; a direction that the Kinect sees turns it along the shortest way, weighted by
// both spreads, unless it is farther off than both allow. A bone without a node takes its parent's
// turn and the Kinect's direction; where nothing shows it, it holds to its parent as it last did.
// The form that docs/fuse.md calls «filter».
#pragma once

#include "kinalign/models/fuse/node_headings.h"
#include "kinalign/models/smoothing.h"

#include <vector>

namespace kinalign {

/// A person's pose in the world.
struct FusedPose {
  std::vector<Turn> rotations;           // [T,B] against the root
  std::vector<Eigen::Quaternionf> root;  // [T] in the world
  std::vector<Eigen::Vector3f> place;    // [T] m, of the root in the world
};

struct BoneFilterOptions {
  double node_deg = 4.0;                          // of a node's rotation, 1 sigma
  double tracked_deg = 6.0, inferred_deg = 25.0;  // of a direction that the Kinect sees
  double gate = 3.0;                              // sigma
  Smoothing smoothing{.window = 11};              // of the Kinect's joints
};

/// `input`: with corrected headings (node_headings.h), or either device alone.
FusedPose filtered_pose(const FuseLayout& layout, const PoseBody& body, const FuseInput& input,
                        const BoneFilterOptions& options = {});

}  // namespace kinalign
