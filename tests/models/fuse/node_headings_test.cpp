// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/node_headings.h"

#include "tests/models/fuse/fuse_people.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr double degree = 0.017453292519943295;

HeadingFilter test_filter(const FuseLayout& layout) {
  return HeadingFilter(layout, pose_body(test_offsets()));
}

std::vector<HeadingState> headings_of(const FuseLayout& layout, const FuseInput& input) {
  const HeadingFilter filter = test_filter(layout);
  return node_headings(filter, input.nodes, directions_of_joints(filter, input.kinect));
}

}  // namespace

TEST_CASE(
    "headings that are off by 20 degrees are found where bones do not hang along the vertical") {
  const FuseLayout layout = fuse_test_layout();
  FusePerson person = fuse_person(1800);
  const std::array<double, 5> off{20.0, -20.0, 12.0, -7.0, 15.0};
  for (std::size_t n = 0; n < off.size(); ++n) turn_heading(person.input.nodes, n, off[n]);
  const auto states = headings_of(layout, person.input);
  for (std::size_t n = 0; n < off.size(); ++n) {
    CAPTURE(n);
    const HeadingState& last = states[states.size() - off.size() + n];
    CHECK(std::abs(static_cast<double>(last.yaw) / degree + off[n]) < 3.0);
    CHECK(static_cast<double>(last.spread) / degree < 6.0);
  }
}

TEST_CASE("corrected nodes lie where they are without the error") {
  const FuseLayout layout = fuse_test_layout();
  const FusePerson person = fuse_person(50);
  NodeFrames turned = person.input.nodes;
  turn_heading(turned, 0, 20.0);
  std::vector<HeadingState> states(50 * 5);
  for (std::size_t t = 0; t < 50; ++t) states[5 * t].yaw = static_cast<float>(-20.0 * degree);
  const NodeFrames again = with_headings(turned, states);
  for (std::size_t i = 0; i < again.orientation.size(); ++i) {
    CHECK(std::abs(again.orientation[i] - person.input.nodes.orientation[i]) < 1e-5F);
  }
  for (std::size_t i = 0; i < again.acceleration.size(); ++i) {
    CHECK(std::abs(again.acceleration[i] - person.input.nodes.acceleration[i]) < 1e-5F);
  }
}

TEST_CASE("without a Kinect a heading stays what it was and its spread grows") {
  const FuseLayout layout = fuse_test_layout();
  FusePerson person = fuse_person(1800);
  for (std::size_t i = 900 * layout.joints.size(); i < person.input.kinect.seen.size(); ++i) {
    person.input.kinect.seen[i] = 0;
  }
  HeadingFilter filter = test_filter(layout);
  const auto directions = directions_of_joints(filter, person.input.kinect);
  HeadingState before;
  for (std::size_t t = 0; t < 1800; ++t) {
    filter.step(person.input.nodes, t, std::span(directions).subspan(5 * t, 5));
    if (t == 899) before = filter.state(0);
  }
  CHECK(filter.state(0).yaw == before.yaw);
  CHECK(filter.state(0).spread > before.spread);
}

TEST_CASE("a Kinect that exchanges left and right for a while turns no heading") {
  const FuseLayout layout = fuse_test_layout();
  FusePerson person = fuse_person(1800);
  const auto clean = headings_of(layout, person.input);
  for (std::size_t t = 600; t < 660; ++t) {
    float* row = &person.input.kinect.positions[3 * t * layout.joints.size()];
    for (const auto& [left, right] : {std::pair{12, 16}, std::pair{5, 9}, std::pair{6, 10}}) {
      for (int k = 0; k < 3; ++k) std::swap(row[3 * left + k], row[3 * right + k]);
    }
  }
  const auto states = headings_of(layout, person.input);
  for (std::size_t n = 0; n < 5; ++n) {
    CAPTURE(n);
    const std::size_t last = states.size() - 5 + n;
    CHECK(std::abs(states[last].yaw - clean[last].yaw) < 0.5 * degree);
  }
}

TEST_CASE("a node whose bone the Kinect does not show keeps its heading") {
  FuseLayout layout = fuse_test_layout();
  layout.nodes.nodes[0] = "head";
  FusePerson person = fuse_person(100);
  turn_heading(person.input.nodes, 0, 20.0);
  CHECK(headings_of(layout, person.input).front().yaw == 0.0F);
}

TEST_CASE("a bone goes three quarters of the way to the rotation of the node that it carries") {
  const FusePerson person = fuse_person(8);
  const FuseLayout layout = fuse_test_layout();
  const auto carried = carried_bones(layout, pose_body(test_offsets()));
  CHECK(carried.size() == 4);  // the waist's node is the root's
  const auto truth = std::span(person.truth.rotations).subspan(0, pose_bones.size());
  std::vector<Turn> turns(truth.begin(), truth.end());
  const float angle = 0.4F;
  for (Turn& turn : turns) turn = turn * Turn(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
  const std::vector<Turn> before = turns;
  turn_to_nodes(carried, person.input.nodes, 0, person.truth.root[0], turns);
  std::size_t moved = 0;
  for (std::size_t b = 0; b < turns.size(); ++b) {
    if (turns[b] == before[b]) continue;
    ++moved;
    const float off = Eigen::Quaternionf(turns[b]).angularDistance(Eigen::Quaternionf(truth[b]));
    CHECK(off == doctest::Approx(0.25F * angle).epsilon(0.001));
  }
  CHECK(moved == 4);
}
