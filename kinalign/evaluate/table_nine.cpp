// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/table_nine.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kinalign {

namespace {

/// E_s of one window: the Frobenius norm of the second differences, divided by T + 2. The first and
/// the last frame are repeated once. The paper writes |Y O| / (T + 2). The corners of its matrix O
/// give first differences; these are 0 because of the repetition.
double roughness(std::span<const double> places, std::size_t joints) {
  const std::size_t width = 3 * joints, frames = places.size() / width;
  const auto at = [&](std::size_t t, std::size_t c) {
    // `t` counts the T + 2 frames.
    const std::size_t frame = t == 0 ? 0 : std::min(t - 1, frames - 1);
    return places[frame * width + c];
  };
  double square = 0.0;
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t t = 1; t <= frames; ++t) {
      const double bend = at(t - 1, c) - 2.0 * at(t, c) + at(t + 1, c);
      square += bend * bend;
    }
  }
  return std::sqrt(square) / static_cast<double>(frames + 2);
}

double length(std::span<const double> places, std::size_t at, const Bone& bone) {
  return (vec3(places, at + bone.a) - vec3(places, at + bone.b)).norm();
}

}  // namespace

TableNine table_nine(std::span<const double> truth, Prediction prediction, std::size_t joints,
                     std::span<const Bone> bones) {
  assert(!truth.empty() && prediction.size() == truth.size());
  Mean position, bone_mean;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    position.add((prediction[i] - truth[i]) * (prediction[i] - truth[i]));
  }
  for (std::size_t at = 0; at < truth.size() / 3; at += joints) {
    for (const Bone& bone : bones) {
      bone_mean.add(std::abs(length(prediction, at, bone) - length(truth, at, bone)));
    }
  }
  return {position.value_or(0.0), bone_mean.value_or(0.0), roughness(prediction, joints),
          roughness(truth, joints)};
}

std::vector<double> own_root(std::span<const double> positions, std::size_t joints,
                             const OwnRootJoints& own) {
  std::vector<double> out(positions.size());
  // The direction to the left is summed over hips and shoulders, so a twisted trunk gets a mean
  // heading.
  for (std::size_t at = 0; at < positions.size() / 3; at += joints) {
    const Vec3 left = vec3(positions, at + own.hip_left) - vec3(positions, at + own.hip_right) +
                      vec3(positions, at + own.shoulder_left) -
                      vec3(positions, at + own.shoulder_right);
    const Quat turn(Eigen::AngleAxisd(std::atan2(left.z(), left.x()), Vec3::UnitY()));
    Vec3 root = vec3(positions, at + own.root);
    // The height stays: only x and z are moved.
    root.y() = 0.0;
    for (std::size_t i = at; i < at + joints; ++i) {
      vec3(out, i) = turn * Vec3(vec3(positions, i) - root);
    }
  }
  return out;
}

}  // namespace kinalign
