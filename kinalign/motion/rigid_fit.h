// SPDX-License-Identifier: Apache-2.0
// Finds the rotation and translation that map points onto points by least squares. It works on
// moments, so one pass over the data in any number of pieces is enough (Umeyama, PAMI 13(4), 1991;
// no scale).
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/arrays.h"

#include <cstddef>

namespace kinalign {

/// p_to = rotation * p_from + translation.
struct RigidTransform {
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();  // m

  Vec3 operator*(const Vec3& p) const { return rotation * p + translation; }
};

/// Sums over pairs of points, relative to origins near the data so that no digits are lost.
struct PairMoments {
  Vec3 from_origin = Vec3::Zero(), to_origin = Vec3::Zero();  // the points of the first pair
  std::size_t count = 0;
  Vec3 from_sum = Vec3::Zero(), to_sum = Vec3::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // sum of to * from^T

  void add(const Vec3& from, const Vec3& to);
};

/// Fails with fewer than three pairs, or with points on one line, because the rotation about that
/// line is undefined.
Result<RigidTransform> fit_rigid(const PairMoments& moments);

/// The spread of the points perpendicular to the line that fits them best, m rms. The larger it is,
/// the better the rotation about that line is determined.
double spread_off_line(const PairMoments& moments);

}  // namespace kinalign
