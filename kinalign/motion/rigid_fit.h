// SPDX-License-Identifier: Apache-2.0
// The rotation and translation that bring points onto points, least squares, from moments: one
// pass over the data in any number of pieces (Umeyama, PAMI 13(4), 1991; no scale).
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

/// Sums over pairs of points, about origins near the data so that no digits are lost.
struct PairMoments {
  Vec3 from_origin = Vec3::Zero(), to_origin = Vec3::Zero();  // the first pair's
  std::size_t count = 0;
  Vec3 from_sum = Vec3::Zero(), to_sum = Vec3::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // sum of to * from^T

  void add(const Vec3& from, const Vec3& to);
};

/// Fails with fewer than three pairs or pairs on one line, where a turn about it is free.
Result<RigidTransform> fit_rigid(const PairMoments& moments);

/// How far the points spread beside the line that they lie nearest to, m rms: a turn about that
/// line is as sure as this is large.
double spread_beside_line(const PairMoments& moments);

}  // namespace kinalign
