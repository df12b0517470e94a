// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/body_frame.h"

#include "kinalign/motion/index_of.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace kinalign {

namespace {

// If a person stands sideways to a Kinect, the line from a left to a right joint becomes short or
// flips. The direction of a shorter line is noise, so it does not change the heading.
constexpr double least_width = 0.15;  // m, summed over the left/right pairs

/// The index of the first of `words` that is among `names`.
std::optional<std::size_t> find(const std::vector<std::string>& names,
                                std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words) {
    if (const auto at = index_of(names, word)) return at;
  }
  return std::nullopt;
}

std::array<double, 3> mean_of(const std::vector<std::size_t>& joints, const float* row) {
  std::array<double, 3> sum{};
  for (const std::size_t j : joints) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += row[3 * j + k];
  }
  for (double& value : sum) value /= static_cast<double>(std::max<std::size_t>(joints.size(), 1));
  return sum;
}

void copy_joint(JointFrames& body, std::size_t from, std::size_t to, std::size_t joint) {
  const float* source = &body.positions[(from * body.joints + joint) * 3];
  std::copy(source, source + 3, &body.positions[(to * body.joints + joint) * 3]);
}

/// Interpolates linearly between frames `before` and `after`, in which the joint was seen.
void fill_between(JointFrames& body, std::size_t joint, std::size_t before, std::size_t after) {
  for (std::size_t t = before + 1; t < after; ++t) {
    const float share = static_cast<float>(t - before) / static_cast<float>(after - before);
    for (std::size_t k = 0; k < 3; ++k) {
      const float a = body.positions[(before * body.joints + joint) * 3 + k];
      const float b = body.positions[(after * body.joints + joint) * 3 + k];
      body.positions[(t * body.joints + joint) * 3 + k] = a + share * (b - a);
    }
  }
}

/// Fills the gaps of one joint in one pass over the frames; see fill_missing(). `last` is the
/// newest frame so far in which the joint was seen. Frames before the first such frame get its
/// position, also if `causal`, because there is no earlier position.
void fill_joint(JointFrames& body, std::size_t joint, bool causal) {
  std::optional<std::size_t> last;
  for (std::size_t t = 0; t < body.frames(); ++t) {
    if (body.seen[t * body.joints + joint] == 0) {
      if (last && causal) copy_joint(body, *last, t, joint);
      continue;
    }
    if (!last) {
      for (std::size_t u = 0; u < t; ++u) copy_joint(body, t, u, joint);
    } else if (!causal) {
      fill_between(body, joint, *last, t);
    }
    last = t;
  }
  // Frames after the last one in which the joint was seen. If `causal`, the loop above has filled
  // them.
  if (!last || causal) return;
  for (std::size_t t = *last + 1; t < body.frames(); ++t) copy_joint(body, *last, t, joint);
}

bool was_seen(const JointFrames& body, std::size_t joint) {
  for (std::size_t t = 0; t < body.frames(); ++t) {
    if (body.seen[t * body.joints + joint] != 0) return true;
  }
  return false;
}

}  // namespace

std::optional<BodyJoints> body_joints(const std::vector<std::string>& names) {
  BodyJoints out;
  const auto pair = [&](std::initializer_list<std::string_view> left,
                        std::initializer_list<std::string_view> right) {
    const auto l = find(names, left), r = find(names, right);
    if (l && r) out.left_right.push_back({*l, *r});
    return l && r;
  };
  const bool hips = pair({"HipLeft", "LeftUpLeg", "UpperLegLeft", "LeftHip", "lfemur", "lhip"},
                         {"HipRight", "RightUpLeg", "UpperLegRight", "RightHip", "rfemur", "rhip"});
  pair({"ShoulderLeft", "LeftArm", "UpperArmLeft", "LeftShoulder", "lhumerus", "lshoulder"},
       {"ShoulderRight", "RightArm", "UpperArmRight", "RightShoulder", "rhumerus", "rshoulder"});
  if (const auto base = find(names, {"SpineBase", "Hips", "Waist", "Pelvis", "root", "hip"})) {
    out.root = {*base};
  } else if (hips) {
    out.root = {out.left_right.front()[0], out.left_right.front()[1]};
  }
  if (out.root.empty() || out.left_right.empty()) return std::nullopt;
  return out;
}

std::array<float, 3> BodyFrame::turned(const float* v) const {
  return {cosine * v[0] + sine * v[2], v[1], cosine * v[2] - sine * v[0]};
}

std::array<float, 3> BodyFrame::turned_back(const float* v) const {
  return {cosine * v[0] - sine * v[2], v[1], cosine * v[2] + sine * v[0]};
}

std::vector<BodyFrame> body_frames(const BodyJoints& joints, const JointFrames& smoothed) {
  std::vector<BodyFrame> out(smoothed.frames());
  BodyFrame last;
  std::optional<std::size_t> first_known;
  for (std::size_t t = 0; t < out.size(); ++t) {
    const float* row = &smoothed.positions[t * smoothed.joints * 3];
    double x = 0.0, z = 0.0;
    for (const auto& [left, right] : joints.left_right) {
      x += row[3 * left] - row[3 * right];
      z += row[3 * left + 2] - row[3 * right + 2];
    }
    const double width = std::hypot(x, z);
    if (width >= least_width) {
      last.cosine = static_cast<float>(x / width);
      last.sine = static_cast<float>(z / width);
      if (!first_known) first_known = t;
    }
    const auto root = mean_of(joints.root, row);
    for (std::size_t k = 0; k < 3; ++k) last.root[k] = static_cast<float>(root[k]);
    out[t] = last;
  }
  // Frames before the first known heading get that heading. Otherwise a body that enters sideways
  // would start with an arbitrary heading.
  for (std::size_t t = 0; first_known && t < *first_known; ++t) {
    out[t].cosine = out[*first_known].cosine;
    out[t].sine = out[*first_known].sine;
  }
  return out;
}

void fill_missing(JointFrames& body, bool causal) {
  // Joints that were never seen come last: their mean needs the filled positions of all others.
  std::vector<std::size_t> seen, never;
  for (std::size_t j = 0; j < body.joints; ++j) {
    (was_seen(body, j) ? seen : never).push_back(j);
    fill_joint(body, j, causal);
  }
  for (std::size_t t = 0; t < body.frames() && !never.empty(); ++t) {
    float* row = &body.positions[t * body.joints * 3];
    const auto mean = mean_of(seen, row);
    for (const std::size_t j : never) {
      for (std::size_t k = 0; k < 3; ++k) row[3 * j + k] = static_cast<float>(mean[k]);
    }
  }
}

}  // namespace kinalign
