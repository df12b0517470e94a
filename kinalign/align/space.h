// SPDX-License-Identifier: Apache-2.0
// Moves points into the reference's space (paper section 3.1, equations (1) and (2)): either once
// per take by a given or fitted rigid transform, or root onto root in every frame, as in the paper.
#pragma once

#include "kinalign/motion/rigid_fit.h"
#include "kinalign/take/take.h"

#include <string>
#include <vector>

namespace kinalign {

/// A joint of a stream and its counterpart, as indices.
struct JointPair {
  std::size_t from = 0, onto = 0;
};

/// The plan for moving one group of points.
struct SpacePlan {
  std::size_t group = 0, onto = 0;  // indices of groups in the take's header
  SpaceOptions options;
  std::vector<JointPair> pairs;  // named joints, for fits and residuals
  JointPair root;                // method paper only
  RigidTransform transform;      // method fit: the result; given: as given; paper: A_rot
  double off_line_m = 0.0;       // method fit: spread_beside_line() of the pairs
};

/// Plans for all streams of the manifest; `header` has the joints. If the manifest names no joints,
/// the usual pairs of Kinect and mocap joints are used, or else joints with equal names.
Result<std::vector<SpacePlan>> plan_spaces(const TakeHeader& header, const Manifest& manifest,
                                           std::size_t reference_group);

/// The pairs used if the manifest names none; docs/align_space.md lists them.
std::vector<std::pair<std::string_view, std::string_view>> usual_pairs();

/// Adds the pairs of a slab in which both joints are valid and tracked.
void add_pairs(const SpacePlan& plan, const TakeSlab& slab, PairMoments& moments);

/// Sums of squared distances between paired joints, before and after the transform. One object
/// serves one space; all slabs of a take must pass through it.
class ResidualSums {
 public:
  explicit ResidualSums(std::size_t pairs) : rows_(pairs), before_(pairs), after_(pairs) {}

  /// Moves the slab's points and adds their distances to the counterparts.
  void transform(const SpacePlan& plan, TakeSlab& slab);
  /// Root mean square distances before and after the transform, for each pair and for all.
  SpaceReport report(const SpacePlan& plan, const TakeHeader& header) const;

 private:
  std::vector<std::uint64_t> rows_;
  std::vector<double> before_, after_;  // m2
};

/// Rotation about the y axis, counter-clockwise seen from +y.
Quat turn_about_y(double degrees);

}  // namespace kinalign
