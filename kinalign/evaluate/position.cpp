// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/position.h"

#include <Eigen/SVD>

#include <cassert>

namespace kinalign {

namespace {

Vec3 mean_place(std::span<const double> places, const std::vector<std::size_t>& cells) {
  Vec3 sum = Vec3::Zero();
  for (const std::size_t i : cells) sum += vec3(places, i);
  return sum / static_cast<double>(cells.size());
}

/// Fits the prediction of one frame onto the truth and appends the remaining distances. Umeyama's
/// closed form: the singular vectors of the cross-covariance give the rotation. The scale is the
/// trace of the singular values, signed, divided by the prediction's spread.
void append_fitted(const Sequence& sequence, Prediction prediction,
                   const std::vector<std::size_t>& cells, std::vector<double>& out) {
  const Vec3 from = mean_place(prediction, cells), to = mean_place(sequence.truth, cells);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  double spread = 0.0;
  for (const std::size_t i : cells) {
    const Vec3 a = vec3(prediction, i) - from;
    cross += (vec3(sequence.truth, i) - to) * a.transpose();
    spread += a.squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& sizes = svd.singularValues();
  // If all joints are on one line, the rotation about that line is undefined.
  if (!(sizes[1] > 1e-9 * sizes[0])) return;
  // The closest orthogonal matrix may be a reflection. Flipping the weakest axis makes it a
  // rotation.
  const bool mirrored = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0;
  const Vec3 signs(1.0, 1.0, mirrored ? -1.0 : 1.0);
  const Eigen::Matrix3d turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const double scale = sizes.dot(signs) / spread;
  for (const std::size_t i : cells) {
    const Vec3 moved = scale * (turn * (vec3(prediction, i) - from)) + to;
    out.push_back((moved - vec3(sequence.truth, i)).norm());
  }
}

}  // namespace

std::vector<double> distances(const Sequence& sequence, Prediction prediction) {
  assert(prediction.size() == sequence.truth.size());
  std::vector<double> out;
  for (std::size_t i = 0; i < sequence.valid.size(); ++i) {
    if (sequence.valid[i] == 0) continue;
    out.push_back((vec3(prediction, i) - vec3(sequence.truth, i)).norm());
  }
  return out;
}

std::vector<double> fitted_distances(const Sequence& sequence, Prediction prediction,
                                     std::size_t least_joints) {
  // With fewer than four joints, a similarity fit has almost as many unknowns (7) as the joints
  // have coordinates.
  assert(prediction.size() == sequence.truth.size() && least_joints >= 4);
  std::vector<double> out;
  std::vector<std::size_t> cells;
  for (std::size_t t = 0; t < sequence.frames(); ++t) {
    cells.clear();
    for (std::size_t j = 0; j < sequence.joints; ++j) {
      if (sequence.has(t, j)) cells.push_back(t * sequence.joints + j);
    }
    if (cells.size() >= least_joints) append_fitted(sequence, prediction, cells, out);
  }
  return out;
}

}  // namespace kinalign
