// SPDX-License-Identifier: Apache-2.0
// Points into the reference's space (paper section 3.1, equations (1) and (2)): once per take by a
// given or fitted rigid transform, or root onto root in every frame as the paper has it.
#pragma once

#include "kinalign/motion/rigid_fit.h"
#include "kinalign/take/take.h"

#include <string>
#include <vector>

namespace kinalign {

/// A stream's joint and its counterpart.
struct JointPair {
  std::size_t from = 0, onto = 0;
};

/// What becomes of one group of points.
struct SpacePlan {
  std::size_t group = 0, onto = 0;  // of the take's header
  SpaceOptions options;
  std::vector<JointPair> pairs;  // named joints, for fits and residuals
  JointPair root;                // paper only
  RigidTransform transform;      // fit: found; given: as given; paper: A_rot
  double beside_line_m = 0.0;    // fit: spread_beside_line of the pairs
};

/// Plans for all streams of the manifest; `header` has the joints. Without named joints the usual
/// pairs of Kinect and mocap joints are taken or, where there are none, joints of equal name.
Result<std::vector<SpacePlan>> plan_spaces(const TakeHeader& header, const Manifest& manifest,
                                           std::size_t reference_group);

/// The counterparts that are used without a manifest's word: docs/align.md lists them.
std::vector<std::pair<std::string_view, std::string_view>> usual_pairs();

/// Adds the pairs of a slab in which both joints are valid and the stream's is tracked.
void add_pairs(const SpacePlan& plan, const TakeSlab& slab, PairMoments& moments);

/// Sums of squared distances of named joints, before and after.
class ResidualSums {
 public:
  explicit ResidualSums(std::size_t pairs) : rows_(pairs), before_(pairs), after_(pairs) {}

  /// Turns the slab's points and adds up their distances to the counterparts.
  void transform(const SpacePlan& plan, TakeSlab& slab);
  SpaceReport report(const SpacePlan& plan, const TakeHeader& header) const;

 private:
  std::vector<std::uint64_t> rows_;
  std::vector<double> before_, after_;  // m2
};

/// Rotation about the y axis, counter-clockwise seen from +y.
Quat turn_about_y(double degrees);

}  // namespace kinalign
