// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

using Names = std::initializer_list<std::string_view>;

bool is_among(std::string_view name, Names names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The angle between two rotations, degrees. It is computed from the chord, because the trace is
/// inexact for small angles.
double angle_between(const Turn& a, const Turn& b) {
  const double half_chord = static_cast<double>((a - b).norm()) / (2.0 * std::numbers::sqrt2);
  return 2.0 * std::asin(std::min(half_chord, 1.0)) * 180.0 / std::numbers::pi;
}

struct Mean {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return count == 0 ? 0.0 : sum / static_cast<double>(count); }
};

std::vector<std::size_t> scored_joints(const Skeleton& skeleton) {
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    if (is_scored_joint(skeleton.joint_names[j])) out.push_back(j);
  }
  return out;
}

/// Mean length of the third difference of the scored joints; positions [T,J,3], result in m/s3.
double jitter_of(const std::vector<float>& positions, std::size_t joints,
                 const std::vector<std::size_t>& scored, double rate_hz) {
  Mean mean;
  const std::size_t row = 3 * joints;
  for (std::size_t at = 3 * row; at + row <= positions.size(); at += row) {
    for (const std::size_t j : scored) {
      Vec3 third;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = at + 3 * j + k;
        third(static_cast<Eigen::Index>(k)) = static_cast<double>(positions[i]) -
                                              3.0 * static_cast<double>(positions[i - row]) +
                                              3.0 * static_cast<double>(positions[i - 2 * row]) -
                                              static_cast<double>(positions[i - 3 * row]);
      }
      // The third difference times rate^3 is the jerk.
      mean.add(third.norm());
    }
  }
  return mean.value() * rate_hz * rate_hz * rate_hz;
}

double position_error(const std::vector<float>& a, const std::vector<float>& b, std::size_t joints,
                      const std::vector<std::size_t>& scored) {
  Mean mean;
  for (std::size_t at = 0; at + 3 * joints <= a.size(); at += 3 * joints) {
    for (const std::size_t j : scored) {
      const std::size_t i = at + 3 * j;
      mean.add(
          static_cast<double>(std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2])));
    }
  }
  return mean.value();
}

}  // namespace

bool is_scored_joint(std::string_view name) {
  return !is_among(name, {"root", "lfemur", "rfemur", "lowerback", "lowerneck", "lclavicle",
                          "rclavicle", "ltoes", "rtoes", "lfingers", "rfingers"});
}

void PoseErrors::add(const PoseErrors& more) {
  const std::size_t all = frames + more.frames;
  if (all == 0) return;
  const double share = static_cast<double>(more.frames) / static_cast<double>(all);
  for (double PoseErrors::*member :
       {&PoseErrors::sip_deg, &PoseErrors::angle_deg, &PoseErrors::head_deg,
        &PoseErrors::position_cm, &PoseErrors::jitter, &PoseErrors::true_jitter}) {
    this->*member += share * (more.*member - this->*member);
  }
  frames = all;
}

PoseErrors pose_errors(const PoseBody& body, std::span<const Turn> answer, const TruePose& truth,
                       double rate_hz) {
  const std::size_t bones = body.bones.size(), joints = body.skeleton.joints();
  Mean sip, angle, head;
  for (std::size_t i = 0; i < answer.size(); ++i) {
    const double error = angle_between(answer[i], truth.rotations[i]);
    const std::string_view name = body.bones[i % bones];
    if (is_among(name, {"lfemur", "rfemur", "lhumerus", "rhumerus"})) sip.add(error);
    (is_among(name, {"upperneck", "head"}) ? head : angle).add(error);
  }
  // Both poses use the true person's bones, so the position error is due to rotations alone.
  const auto ours = bone_positions(body, truth.rest_offsets, answer);
  const auto theirs = bone_positions(body, truth.rest_offsets, truth.rotations);
  const auto scored = scored_joints(body.skeleton);
  return {.sip_deg = sip.value(),
          .angle_deg = angle.value(),
          .head_deg = head.value(),
          .position_cm = 100.0 * position_error(ours, theirs, joints, scored),
          .jitter = jitter_of(ours, joints, scored, rate_hz),
          .true_jitter = jitter_of(theirs, joints, scored, rate_hz),
          .frames = answer.size() / bones};
}

}  // namespace kinalign
