// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/rigid_fit.h"

#include <Eigen/SVD>

#include <cmath>
#include <string>

namespace kinalign {

namespace {

/// The same sums about other origins.
PairMoments moved(const PairMoments& m, const Vec3& from_origin, const Vec3& to_origin) {
  const Vec3 a = m.from_origin - from_origin, b = m.to_origin - to_origin;
  const auto n = static_cast<double>(m.count);
  PairMoments out = m;
  out.from_origin = from_origin;
  out.to_origin = to_origin;
  out.from_sum = m.from_sum + n * a;
  out.to_sum = m.to_sum + n * b;
  out.from_square = m.from_square + 2.0 * a.dot(m.from_sum) + n * a.squaredNorm();
  out.to_square = m.to_square + 2.0 * b.dot(m.to_sum) + n * b.squaredNorm();
  out.cross =
      m.cross + b * m.from_sum.transpose() + m.to_sum * a.transpose() + n * (b * a.transpose());
  return out;
}

/// Of both sides' points, each about its mean, m2.
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
  from_square += a.squaredNorm();
  to_square += b.squaredNorm();
  cross += b * a.transpose();
}

void PairMoments::add(const PairMoments& other) {
  if (other.count == 0) return;
  if (count == 0) {
    *this = other;
    return;
  }
  const PairMoments more = moved(other, from_origin, to_origin);
  count += more.count;
  from_sum += more.from_sum;
  to_sum += more.to_sum;
  from_square += more.from_square;
  to_square += more.to_square;
  cross += more.cross;
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
    return Failure(Error{"", 0, "points that do not lie on one line", "a line"});
  }
  Vec3 signs(1.0, 1.0, 1.0);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs[2] = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  RigidTransform transform;
  transform.rotation = Quat(rotation).normalized();
  transform.translation = m.to_origin + to_mean - transform.rotation * (m.from_origin + from_mean);
  return transform;
}

double spread_beside_line(const PairMoments& m) {
  if (m.count == 0) return 0.0;
  return std::sqrt(Eigen::JacobiSVD<Eigen::Matrix3d>(covariance(m)).singularValues()[1]);
}

double rms_residual(const PairMoments& m, const RigidTransform& transform) {
  if (m.count == 0) return 0.0;
  const auto n = static_cast<double>(m.count);
  const Eigen::Matrix3d r = transform.rotation.toRotationMatrix();
  // sum |b - R a - c|^2 with a, b about the origins and c what the origins leave over
  const Vec3 c = transform * m.from_origin - m.to_origin;
  const double square = m.to_square + m.from_square + n * c.squaredNorm() -
                        2.0 * (m.cross.transpose() * r).trace() - 2.0 * c.dot(m.to_sum) +
                        2.0 * c.dot(r * m.from_sum);
  return std::sqrt(std::max(square, 0.0) / n);
}

}  // namespace kinalign
