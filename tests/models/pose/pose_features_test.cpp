// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_features.h"

#include "tests/models/pose/pose_people.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

/// Nodes of a person who stands still in the calibration's zero pose.
NodeFrames still_nodes(std::size_t count) {
  NodeFrames out;
  out.nodes = count;
  for (std::size_t n = 0; n < count; ++n) {
    append_sample(out, Eigen::Quaternionf::Identity(), Eigen::Vector3f::Zero(),
                  Eigen::Vector3f::Zero());
  }
  return out;
}

double farthest(const std::vector<float>& a, const std::vector<float>& b) {
  double out = a.size() == b.size() ? 0.0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    out = std::max(out, std::abs(static_cast<double>(a[i] - b[i])));
  }
  return out;
}

}  // namespace

TEST_CASE("five nodes give 61 channels, 48 of DIP") {
  PoseLayout layout = test_layout();
  CHECK(layout.channels() == 61);
  CHECK(layout.answers() == 90);
  layout.inputs = PoseInputs::dip;
  CHECK(layout.channels() == 48);
}

TEST_CASE("a still T-pose: identities, no acceleration, the vertical up, every leaf valid") {
  const auto features = pose_features(test_layout(), still_nodes(5));
  std::vector<float> expected;
  for (int n = 0; n < 4; ++n) expected.insert(expected.end(), {1, 0, 0, 0, 1, 0});
  expected.insert(expected.end(), 12, 0.0F);
  expected.insert(expected.end(), {0, 1, 0});
  expected.insert(expected.end(), 3 + 15, 0.0F);
  expected.insert(expected.end(), 4, 1.0F);
  CHECK(features.input == expected);
  PoseLayout dip = test_layout();
  dip.inputs = PoseInputs::dip;
  expected.clear();
  for (int n = 0; n < 4; ++n) expected.insert(expected.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1});
  expected.insert(expected.end(), 12, 0.0F);
  CHECK(pose_features(dip, still_nodes(5)).input == expected);
}

TEST_CASE("accelerations and angular velocities have their places and units") {
  NodeFrames nodes = still_nodes(5);
  nodes.acceleration[0] = 20.0F;         // wrist_left, x
  nodes.acceleration[3 * 4 + 1] = 5.0F;  // waist, y
  nodes.angular_velocity[3 * 4 + 2] = 6.0F;
  const auto input = pose_features(test_layout(), nodes).input;
  CHECK(input[24] == 2.0F);
  CHECK(input[25] == -0.5F);  // against the root's axes
  CHECK(input[36 + 3 + 1] == 0.5F);
  CHECK(input[42 + 12 + 2] == 2.0F);
}

TEST_CASE("features do not depend on the direction in which a person looks") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const NodeFrames nodes = random_nodes(5, 7, random);
    NodeFrames turned = nodes;
    const Eigen::Quaternionf yaw(Eigen::AngleAxisf(2.1F, Eigen::Vector3f::UnitY()));
    for (std::size_t i = 0; i < nodes.valid.size(); ++i) {
      const float* q = &nodes.orientation[4 * i];
      const Eigen::Quaternionf p = yaw * Eigen::Quaternionf(q[0], q[1], q[2], q[3]);
      float* to = &turned.orientation[4 * i];
      to[0] = p.w(), to[1] = p.x(), to[2] = p.y(), to[3] = p.z();
      Eigen::Map<Eigen::Vector3f> a(&turned.acceleration[3 * i]);
      a = (yaw * Eigen::Vector3f(a)).eval();
    }
    // The limit is a dozen roundings of numbers up to 2.
    CHECK(farthest(pose_features(test_layout(), nodes).input,
                   pose_features(test_layout(), turned).input) < 5e-6);
  }
}

TEST_CASE("a leaf without samples has zeros, whatever stands in its arrays") {
  std::mt19937_64 random(3);
  NodeFrames nodes = random_nodes(5, 1, random), broken = nodes;
  nodes.valid[1] = 0;
  broken.acceleration[3] = std::numeric_limits<float>::quiet_NaN();
  const auto input = pose_features(test_layout(), nodes).input;
  for (std::size_t c = 6; c < 12; ++c) CHECK(input[c] == 0.0F);
  for (std::size_t c = 27; c < 30; ++c) CHECK(input[c] == 0.0F);
  for (std::size_t c = 45; c < 48; ++c) CHECK(input[c] == 0.0F);
  CHECK(input[58] == 0.0F);
  CHECK(pose_features(test_layout(), broken).input == input);
}

TEST_CASE("the root's last orientation holds while its node is silent") {
  std::mt19937_64 random(4);
  NodeFrames nodes = random_nodes(5, 3, random);
  nodes.valid[4] = 0;
  nodes.valid[14] = 0;
  const auto root = pose_features(test_layout(), nodes).root;
  CHECK(root[0].isApprox(Eigen::Quaternionf::Identity()));
  CHECK(root[1].w() == doctest::Approx(nodes.orientation[4 * 9]).epsilon(1e-6));
  CHECK(root[2].isApprox(root[1]));
}

TEST_CASE("a layout has 3 to 6 nodes with different names") {
  PoseLayout layout = test_layout();
  CHECK(validate(layout));
  layout.nodes = {"waist", "head"};
  CHECK(to_string(validate(layout).error()) == "expected 3 to 6 nodes, found 2");
  layout.nodes = {"head", "waist", "head"};
  CHECK(to_string(validate(layout).error()) ==
        "expected nodes with different names, found a name twice");
}
