// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/residuals.h"

#include "kinalign/motion/arrays.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::size_t joints = mapped_joints;
constexpr double far_off_m = 0.10, frame_s = 1.0 / 30.0;
constexpr std::array<std::size_t, 3> lags{1, 5, 15};

/// The rotation into the body's heading; its rows are the person's left, up and front.
Eigen::Matrix3d heading_from_space(const std::vector<double>& truth, std::size_t t) {
  const std::size_t i = t * joints;
  Vec3 left = vec3(truth, i + 10) - vec3(truth, i + 14) + vec3(truth, i + 4) - vec3(truth, i + 7);
  left.y() = 0.0;
  left.normalize();
  Eigen::Matrix3d axes;
  axes << left.transpose(), Vec3::UnitY().transpose(), left.cross(Vec3::UnitY()).transpose();
  return axes;
}

/// Kinect minus truth, [F,18,3] m, in heading space.
std::vector<double> residuals(const Repetition& piece) {
  std::vector<double> out(piece.kinect.size());
  for (std::size_t t = 0; t < piece.frames; ++t) {
    const Eigen::Matrix3d axes = heading_from_space(piece.truth, t);
    for (std::size_t i = t * joints; i < (t + 1) * joints; ++i) {
      vec3(out, i) = axes * (vec3(piece.kinect, i) - vec3(piece.truth, i));
    }
  }
  return out;
}

struct JointSums {
  double count = 0.0, square = 0.0, far_off = 0.0;
  std::array<double, 3> lagged{}, lagged_square{};
};

void add_piece(const Repetition& piece, const std::vector<double>& left,
               const std::array<Vec3, joints>& mean, std::array<JointSums, joints>& sums) {
  for (std::size_t i = 0; i < piece.valid.size(); ++i) {
    if (piece.valid[i] == 0) continue;
    const std::size_t j = i % joints;
    const Vec3 now = vec3(left, i) - mean[j];
    sums[j].count += 1.0;
    sums[j].square += now.squaredNorm();
    if (now.norm() > far_off_m) sums[j].far_off += 1.0;
    for (std::size_t l = 0; l < lags.size(); ++l) {
      const std::size_t later = i + lags[l] * joints;
      if (later >= piece.valid.size() || piece.valid[later] == 0) continue;
      const Vec3 then = vec3(left, later) - mean[j];
      sums[j].lagged[l] += now.dot(then);
      sums[j].lagged_square[l] += 0.5 * (now.squaredNorm() + then.squaredNorm());
    }
  }
}

std::array<Vec3, joints> mean_residual(std::span<const Repetition> take,
                                       const std::vector<std::vector<double>>& left) {
  std::array<Vec3, joints> sum;
  sum.fill(Vec3::Zero());
  std::array<double, joints> count{};
  for (std::size_t p = 0; p < take.size(); ++p) {
    for (std::size_t i = 0; i < take[p].valid.size(); ++i) {
      if (take[p].valid[i] == 0) continue;
      sum[i % joints] += vec3(left[p], i);
      count[i % joints] += 1.0;
    }
  }
  for (std::size_t j = 0; j < joints; ++j) sum[j] /= std::max(count[j], 1.0);
  return sum;
}

constexpr std::array<std::size_t, joint_rows.size()> white_group_of{0, 0, 0, 0, 0, 1,
                                                                    1, 0, 2, 3, 3};

double robust_mm(std::vector<double>& differences) {
  if (differences.empty()) return 0.0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return 1000.0 * 1.4826 * *middle / std::sqrt(6.0);
}

}  // namespace

void put_residuals(const std::vector<Repetition>& pieces, Figures& figures) {
  std::array<JointSums, joints> sums{};
  for (const TakeRange& range : takes(pieces)) {
    const std::span<const Repetition> take(&pieces[range.begin], range.end - range.begin);
    std::vector<std::vector<double>> left;
    for (const Repetition& piece : take) left.push_back(residuals(piece));
    const auto mean = mean_residual(take, left);
    for (std::size_t p = 0; p < take.size(); ++p) add_piece(take[p], left[p], mean, sums);
  }
  std::array<double, joint_rows.size()> sides{};
  for (const std::size_t row : row_of) sides[row] += 1.0;
  for (std::size_t j = 0; j < joints; ++j) {
    const JointSums& s = sums[j];
    const double share = 1.0 / sides[row_of[j]];
    figures.within[j] = 100.0 * std::sqrt(s.square / s.count / 3.0);
    figures.within_row[row_of[j]] += share * figures.within[j];
    figures.far_off[row_of[j]] += share * s.far_off / s.count;
    for (std::size_t l = 0; l < lags.size(); ++l) {
      const double rho = s.lagged[l] / s.lagged_square[l];
      figures.autocorrelation[l] += rho / static_cast<double>(joints);
      figures.autocorrelation_row[row_of[j]][l] += share * rho;
    }
  }
}

void put_white(const std::vector<Repetition>& pieces, Figures& figures) {
  std::array<std::array<std::vector<double>, speed_bins>, white_groups> differences;
  for (const Repetition& piece : pieces) {
    for (std::size_t i = joints; i + joints < piece.valid.size(); ++i) {
      if (piece.valid[i - joints] == 0 || piece.valid[i] == 0 || piece.valid[i + joints] == 0)
        continue;
      const double speed =
          (vec3(piece.truth, i + joints) - vec3(piece.truth, i - joints)).norm() / (2.0 * frame_s);
      const auto edge = std::upper_bound(speed_edges.begin(), speed_edges.end(), speed);
      if (edge == speed_edges.end()) continue;
      const auto bin = static_cast<std::size_t>(edge - speed_edges.begin()) - 1;
      const auto left = [&](std::size_t k) {
        return Vec3(vec3(piece.kinect, k) - vec3(piece.truth, k));
      };
      const Vec3 second = left(i - joints) - 2.0 * left(i) + left(i + joints);
      auto& into = differences[white_group_of[row_of[i % joints]]][bin];
      for (const double d : second) into.push_back(std::abs(d));
    }
  }
  for (std::size_t g = 0; g < white_groups; ++g) {
    for (std::size_t b = 0; b < speed_bins; ++b) figures.white[g][b] = robust_mm(differences[g][b]);
  }
}

}  // namespace kinalign
