// SPDX-License-Identifier: Apache-2.0
// A person who swings all bones, before a Kinect without noise, with nodes without errors.
#pragma once

#include "tests/models/pose/pose_people.h"

#include "kinalign/models/fuse/bone_filter.h"
#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/models/fuse/fuse_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace kinalign {

inline FuseLayout fuse_test_layout() { return {test_layout(), fuse_joint_names()}; }

struct FusePerson {
  FusedPose truth;
  FuseInput input;
};

/// `frames` at 30 Hz. The person looks along z at first and turns; forearms are not vertical.
inline FusePerson fuse_person(std::size_t frames) {
  const PoseBody body = pose_body(test_offsets());
  static constexpr std::array<std::size_t, 4> carriers{11, 14, 1, 3};  // wrists, shanks
  FusePerson out;
  out.input.nodes.nodes = 5;
  out.input.kinect.joints = fuse_joints.size();
  for (std::size_t t = 0; t < frames; ++t) {
    const float phase = 0.1F * static_cast<float>(t);
    const Eigen::Quaternionf root(
        Eigen::AngleAxisf(0.4F * std::sin(0.2F * phase), Eigen::Vector3f::UnitY()));
    const Eigen::Vector3f place(0.1F * std::sin(phase), 0.9F, -2.0F);
    std::vector<Turn> turns;
    for (std::size_t b = 0; b < pose_bones.size(); ++b) {
      const float angle = 0.3F * std::sin(phase + static_cast<float>(b));
      const Eigen::Vector3f axis = b % 2 == 0 ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitZ();
      turns.push_back(Eigen::AngleAxisf(angle, axis).toRotationMatrix());
    }
    for (const std::size_t b : carriers) {
      append_sample(out.input.nodes, (root * Eigen::Quaternionf(turns[b])).normalized(),
                    Eigen::Vector3f(1.0F, 0.0F, 0.0F), Eigen::Vector3f::Zero());
    }
    append_sample(out.input.nodes, root, Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero());
    const auto places = bone_positions(body, body.skeleton.rest_offsets, turns);
    for (const FuseJoint& joint : fuse_joints) {
      const auto& names = body.skeleton.joint_names;
      const auto j = static_cast<std::size_t>(std::find(names.begin(), names.end(), joint.body) -
                                              names.begin());
      const Eigen::Vector3f at =
          place + root * Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(&places[3 * j]));
      for (const float value : at) out.input.kinect.positions.push_back(value);
      out.input.kinect.seen.push_back(2);
    }
    out.truth.rotations.insert(out.truth.rotations.end(), turns.begin(), turns.end());
    out.truth.root.push_back(root);
    out.truth.place.push_back(place);
  }
  return out;
}

/// Turns the world of node `n` about the vertical, degrees.
inline void turn_heading(NodeFrames& nodes, std::size_t n, double degrees) {
  const Eigen::Quaternionf yaw(Eigen::AngleAxisf(static_cast<float>(degrees * 0.017453292519943295),
                                                 Eigen::Vector3f::UnitY()));
  for (std::size_t at = n; at < nodes.valid.size(); at += nodes.nodes) {
    float* q = &nodes.orientation[4 * at];
    const Eigen::Quaternionf turned = yaw * Eigen::Quaternionf(q[0], q[1], q[2], q[3]);
    q[0] = turned.w();
    q[1] = turned.x();
    q[2] = turned.y();
    q[3] = turned.z();
    Eigen::Map<Eigen::Vector3f> a(&nodes.acceleration[3 * at]);
    a = (yaw * Eigen::Vector3f(a)).eval();
  }
}

/// A model of one convolution with three taps and random weights.
inline FuseModel random_fuse_model(std::uint64_t seed, bool causal = true) {
  std::mt19937_64 random(seed);
  FuseModel out;
  out.facts = {"fuse", "test", "", "", ""};
  out.layout = fuse_test_layout();
  out.body = pose_body(test_offsets());
  const std::size_t in = out.layout.channels(), answers = out.layout.answers();
  out.input_mean.assign(in, 0.1F);
  out.input_scale.assign(in, 0.9F);
  out.architecture = {in,
                      {{.kind = LayerKind::conv, .out = answers, .kernel = 3, .causal = causal}}};
  std::uniform_real_distribution<float> weight(-0.03F, 0.03F);
  Tensor weights{{answers, in, 3}, {}}, bias{{answers}, {}};
  for (std::size_t i = 0; i < answers * in * 3; ++i) weights.values.push_back(weight(random));
  for (std::size_t i = 0; i < answers; ++i) bias.values.push_back(weight(random));
  out.tensors = {{"net.0.weight", weights}, {"net.0.bias", bias}};
  return out;
}

inline void lose_all(std::vector<std::uint8_t>& flags) {
  std::fill(flags.begin(), flags.end(), std::uint8_t{0});
}

}  // namespace kinalign
