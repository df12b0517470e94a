// SPDX-License-Identifier: Apache-2.0
// A person who swings, as training data.
#pragma once

#include "tests/models/pose/pose_people.h"

#include "kinalign/infer/architecture.h"
#include "kinalign/learn/pose/pose_data.h"

#include <array>
#include <cmath>

namespace kinalign {

/// A person whose bones swing, and the samples of its nodes.
inline PoseSequence swinging(std::size_t frames, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  PoseSequence out{.subject = "01",
                   .action = "swing",
                   .nodes = {},
                   .rotations = {},
                   .places = {},
                   .rest_offsets = test_offsets()};
  out.nodes.nodes = 5;
  std::vector<Eigen::Vector3f> axes;
  for (std::size_t b = 0; b < pose_bones.size(); ++b) {
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    axes.emplace_back(x, y, z);
  }
  static constexpr std::array<std::size_t, 4> carriers{11, 14, 1, 3};  // wrists, shanks
  for (std::size_t t = 0; t < frames; ++t) {
    out.places.emplace_back(0.0, 0.9, 0.0);
    const float swing = std::sin(0.15F * static_cast<float>(t));
    for (const Eigen::Vector3f& axis : axes) {
      out.rotations.push_back(Eigen::AngleAxisf(swing, axis.normalized()).toRotationMatrix());
    }
    const Turn* frame = &out.rotations[t * axes.size()];
    for (const std::size_t b : carriers) {
      append_sample(out.nodes, Eigen::Quaternionf(frame[b]), swing * axes[b], axes[b]);
    }
    append_sample(out.nodes, Eigen::Quaternionf::Identity(), Eigen::Vector3f::Zero(),
                  Eigen::Vector3f::Zero());
  }
  return out;
}

inline PoseData swinging_data() {
  return {.nodes = usual_pose_nodes(),
          .body = pose_body(test_offsets()),
          .learnt = {swinging(24, 1)},
          .judged = {swinging(24, 1)},
          .tested = {},
          .left_out = {}};
}

inline void without_dropout(std::vector<Layer>& layers) {
  for (Layer& layer : layers) {
    layer.rate = 0.0;
    for (auto& branch : layer.branches) without_dropout(branch);
  }
}

}  // namespace kinalign
