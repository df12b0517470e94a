// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/rigid_fit.h"

#include <Eigen/SVD>

#include <cmath>
#include <string>

namespace kinalign {

namespace {

/// The cross-covariance of the two sets of points, each relative to its mean, m2.
Eigen::Matrix3d covariance(const PairMoments& m) {
  const auto n = static_cast<double>(m.count);
  return m.cross / n - (m.to_sum / n) * (m.from_sum / n).transpose();
}

}  // namespace

void PairMoments::add(const Vec3& from, const Vec3& to) {
  if (count == 0) {
    from_origin = from;
    to_origin = to;
  }
  const Vec3 a = from - from_origin, b = to - to_origin;
  ++count;
  from_sum += a;
  to_sum += b;
  cross += b * a.transpose();
}

Result<RigidTransform> fit_rigid(const PairMoments& m) {
  if (m.count < 3) {
    return Failure(Error{"", 0, "three pairs of points for a rigid fit", std::to_string(m.count)});
  }
  const auto n = static_cast<double>(m.count);
  const Vec3 from_mean = m.from_sum / n, to_mean = m.to_sum / n;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance(m),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& sizes = svd.singularValues();
  if (!(sizes[1] > 1e-9 * sizes[0])) {
    return Failure(Error{"", 0, "points that are not on one line", "a line"});
  }
  Vec3 signs(1.0, 1.0, 1.0);
  // Without the sign the best orthogonal matrix could be a reflection.
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs[2] = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  RigidTransform transform;
  transform.rotation = Quat(rotation).normalized();
  transform.translation = m.to_origin + to_mean - transform.rotation * (m.from_origin + from_mean);
  return transform;
}

double spread_off_line(const PairMoments& m) {
  if (m.count == 0) return 0.0;
  return std::sqrt(Eigen::JacobiSVD<Eigen::Matrix3d>(covariance(m)).singularValues()[1]);
}

}  // namespace kinalign
