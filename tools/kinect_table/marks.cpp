// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/marks.h"

#include "kinalign/motion/arrays.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::size_t joints = mapped_joints;

struct MappedBone {
  std::size_t a, b;
};
constexpr std::array<MappedBone, 11> bones{{{4, 5},
                                            {5, 6},
                                            {7, 8},
                                            {8, 9},
                                            {10, 14},
                                            {10, 11},
                                            {11, 12},
                                            {12, 13},
                                            {14, 15},
                                            {15, 16},
                                            {16, 17}}};

double length(const std::vector<double>& places, std::size_t t, const MappedBone& bone) {
  return (vec3(places, t * joints + bone.a) - vec3(places, t * joints + bone.b)).norm();
}

bool has(const Repetition& piece, std::size_t t, const MappedBone& bone) {
  return piece.valid[t * joints + bone.a] != 0 && piece.valid[t * joints + bone.b] != 0;
}

/// Median true length of each bone over a take, m; 0 where it was never there.
std::array<double, bones.size()> true_lengths(std::span<const Repetition> take) {
  std::array<double, bones.size()> medians{};
  for (std::size_t b = 0; b < bones.size(); ++b) {
    std::vector<double> lengths;
    for (const Repetition& piece : take) {
      for (std::size_t t = 0; t < piece.frames; ++t) {
        if (has(piece, t, bones[b])) lengths.push_back(length(piece.truth, t, bones[b]));
      }
    }
    if (lengths.empty()) continue;
    auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    medians[b] = *middle;
  }
  return medians;
}

struct Mean {
  double sum = 0.0, count = 0.0;
  void add(double value) {
    sum += value;
    count += 1.0;
  }
  double value() const { return count > 0.0 ? sum / count : 0.0; }
};

double mean_distance(const Repetition& piece) {
  Mean mean;
  for (std::size_t i = 0; i < piece.valid.size(); ++i) {
    if (piece.valid[i] != 0) mean.add((vec3(piece.kinect, i) - vec3(piece.truth, i)).norm());
  }
  return mean.value();
}

/// Sum of distances of one frame after the similarity that brings the Kinect onto the truth.
void add_similar_distances(const Repetition& piece, std::size_t t, Mean& mean) {
  std::vector<std::size_t> valid;
  for (std::size_t j = 0; j < joints; ++j) {
    if (piece.valid[t * joints + j] != 0) valid.push_back(t * joints + j);
  }
  if (valid.size() < 12) return;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  for (const std::size_t i : valid) {
    from += vec3(piece.kinect, i) / static_cast<double>(valid.size());
    to += vec3(piece.truth, i) / static_cast<double>(valid.size());
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  double spread = 0.0;
  for (const std::size_t i : valid) {
    const Vec3 a = vec3(piece.kinect, i) - from;
    cross += (vec3(piece.truth, i) - to) * a.transpose();
    spread += a.squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double mirror =
      (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Vec3 signs(1.0, 1.0, mirror);
  const Eigen::Matrix3d turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const Vec3 stretch = svd.singularValues();
  const double scale = stretch.dot(signs) / std::max(spread, 1e-12);
  for (const std::size_t i : valid) {
    const Vec3 moved = scale * (turn * (vec3(piece.kinect, i) - from)) + to;
    mean.add((moved - vec3(piece.truth, i)).norm());
  }
}

void add_bones(const Repetition& piece, const std::array<double, bones.size()>& lengths,
               Mean& error, Mean& constancy) {
  Mean in_piece;
  Mean deviations;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    Mean mean, square;
    std::vector<double> seen;
    for (std::size_t t = 0; t < piece.frames; ++t) {
      if (has(piece, t, bones[b])) seen.push_back(length(piece.kinect, t, bones[b]));
    }
    if (lengths[b] <= 0.0 || seen.size() < 5) continue;
    for (const double l : seen) {
      mean.add(l);
      in_piece.add(std::abs(l - lengths[b]));
    }
    for (const double l : seen) square.add((l - mean.value()) * (l - mean.value()));
    deviations.add(std::sqrt(square.value()));
  }
  error.add(in_piece.value());
  constancy.add(deviations.value());
}

Vec3 second_difference(const std::vector<double>& places, std::size_t i) {
  return vec3(places, i) - 2.0 * vec3(places, i + joints) + vec3(places, i + 2 * joints);
}
Vec3 third_difference(const std::vector<double>& places, std::size_t i) {
  return second_difference(places, i + joints) - second_difference(places, i);
}

bool valid_from(const Repetition& piece, std::size_t i, std::size_t frames) {
  for (std::size_t k = 0; k < frames; ++k) {
    if (piece.valid[i + k * joints] == 0) return false;
  }
  return true;
}

double acceleration_error(const Repetition& piece, const std::vector<double>& kinect) {
  Mean mean;
  for (std::size_t i = 0; i + 2 * joints < piece.valid.size(); ++i) {
    if (!valid_from(piece, i, 3)) continue;
    mean.add((second_difference(kinect, i) - second_difference(piece.truth, i)).norm());
  }
  return mean.value();
}

double mean_third_difference(const Repetition& piece, const std::vector<double>& places) {
  Mean mean;
  for (std::size_t i = 0; i + 3 * joints < piece.valid.size(); ++i) {
    if (valid_from(piece, i, 4)) mean.add(third_difference(places, i).norm());
  }
  return mean.value();
}

constexpr std::size_t window = 9;

/// Weights of a window of nine that give its quadratic's value at place `at` in -4 … 4 (Savitzky
/// and Golay): from sums over k of 1, k^2 and k^4, which are 9, 60 and 708.
std::array<double, window> quadratic_weights(double at) {
  std::array<double, window> weights{};
  constexpr double s0 = 9.0, s2 = 60.0, s4 = 708.0, apart = s0 * s4 - s2 * s2;
  for (std::size_t i = 0; i < window; ++i) {
    const double k = static_cast<double>(i) - 4.0;
    weights[i] = (s4 - s2 * k * k) / apart + at * k / s2 + at * at * (s0 * k * k - s2) / apart;
  }
  return weights;
}

std::vector<double> smoothed(const Repetition& piece) {
  std::vector<double> out = piece.kinect;
  if (piece.frames < window) return out;
  for (std::size_t t = 0; t < piece.frames; ++t) {
    const std::size_t first = std::clamp<std::size_t>(t, 4, piece.frames - 5) - 4;
    const auto weights =
        quadratic_weights(static_cast<double>(t) - static_cast<double>(first) - 4.0);
    for (std::size_t c = 0; c < 3 * joints; ++c) {
      double sum = 0.0;
      for (std::size_t i = 0; i < window; ++i) {
        sum += weights[i] * piece.kinect[(first + i) * 3 * joints + c];
      }
      out[t * 3 * joints + c] = sum;
    }
  }
  return out;
}

}  // namespace

void put_marks(const std::vector<Repetition>& pieces, Figures& figures) {
  Mean mpjpe, pa, bone, constancy, acceleration, calm, jitter, true_jitter;
  for (const TakeRange& range : takes(pieces)) {
    const std::span<const Repetition> take(&pieces[range.begin], range.end - range.begin);
    const auto lengths = true_lengths(take);
    for (const Repetition& piece : take) {
      mpjpe.add(mean_distance(piece));
      Mean similar;
      for (std::size_t t = 0; t < piece.frames; ++t) add_similar_distances(piece, t, similar);
      if (similar.count > 0.0) pa.add(similar.value());
      add_bones(piece, lengths, bone, constancy);
      acceleration.add(acceleration_error(piece, piece.kinect));
      calm.add(acceleration_error(piece, smoothed(piece)));
      jitter.add(mean_third_difference(piece, piece.kinect));
      true_jitter.add(mean_third_difference(piece, piece.truth));
    }
  }
  figures.mpjpe = 100.0 * mpjpe.value();
  figures.pa = 100.0 * pa.value();
  figures.bone = 100.0 * bone.value();
  figures.constancy = 100.0 * constancy.value();
  figures.acceleration = 1000.0 * acceleration.value();
  figures.acceleration_smoothed = 1000.0 * calm.value();
  figures.jitter = jitter.value() / std::max(true_jitter.value(), 1e-12);
}

}  // namespace kinalign
