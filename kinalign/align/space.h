// SPDX-License-Identifier: Apache-2.0
// Moves points into the space of the reference (HFUT-MMD paper, section 3.1, equations (1) and
// (2)). There are two ways: a given or fitted rigid transform for the whole take, or a translation
// in every frame that puts the root joint on the other stream's root (method "paper").
#pragma once

#include "kinalign/motion/rigid_fit.h"
#include "kinalign/take/take.h"

#include <string>
#include <vector>

namespace kinalign {

/// A joint of a stream and the joint onto which it is moved, as indices.
struct JointPair {
  std::size_t from = 0, onto = 0;
};

/// The plan for moving the points of one group.
struct SpacePlan {
  std::size_t group = 0, onto = 0;  // indices of groups in the take's header
  SpaceOptions options;
  std::vector<JointPair> pairs;  // joints that have a counterpart, for fits and residuals
  JointPair root;                // used only by the method "paper"
  RigidTransform transform;      // "fit": the result; "given": as given; "paper": rotation A_rot
  double off_line_m = 0.0;       // method "fit": spread_off_line() of the pairs, m
};

/// Plans the spaces of all streams in the manifest. `header` has the joint names. If the manifest
/// names no joints, the usual pairs of Kinect and mocap joints are used, or else joints with equal
/// names.
Result<std::vector<SpacePlan>> plan_spaces(const TakeHeader& header, const Manifest& manifest,
                                           std::size_t reference_group);

/// The pairs that are used if the manifest names none (docs/align_space.md).
std::vector<std::pair<std::string_view, std::string_view>> usual_pairs();

/// Adds the pairs of joints of a slab that are both valid and tracked.
void add_pairs(const SpacePlan& plan, const TakeSlab& slab, PairMoments& moments);

/// Sums of squared distances between paired joints, before and after the transform. One object is
/// for one space and must get all slabs of a take.
class ResidualSums {
 public:
  explicit ResidualSums(std::size_t pairs) : rows_(pairs), before_(pairs), after_(pairs) {}

  /// Moves the slab's points and adds their distances to their counterparts.
  void transform(const SpacePlan& plan, TakeSlab& slab);
  /// Returns the root mean square distances before and after the transform, for each pair and for
  /// all pairs.
  SpaceReport report(const SpacePlan& plan, const TakeHeader& header) const;

 private:
  std::vector<std::uint64_t> rows_;
  std::vector<double> before_, after_;  // m2
};

/// Returns the rotation about the y axis, counter-clockwise seen from +y.
Quat turn_about_y(double degrees);

}  // namespace kinalign
