// SPDX-License-Identifier: Apache-2.0
#include "tests/learn/fuse/fuse_swinging.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

/// The tracked joints' median distance from their true positions, m, and the share of joints that
/// are tracked.
struct Seen {
  double median = 0.0, tracked = 0.0;
};

Seen seen_of(const PoseBody& body, const PoseSequence& one, const JointFrames& kinect) {
  const auto places = bone_positions(body, one.rest_offsets, one.rotations);
  const auto roots = true_roots(one);
  const auto& names = body.skeleton.joint_names;
  std::vector<double> off;
  for (std::size_t t = 0; t < one.frames(); ++t) {
    for (std::size_t k = 0; k < fuse_joints.size(); ++k) {
      if (kinect.seen[t * fuse_joints.size() + k] != 2) continue;
      const auto j = static_cast<std::size_t>(
          std::find(names.begin(), names.end(), fuse_joints[k].body) - names.begin());
      const Eigen::Vector3f place = roots[t] * Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(
                                                   &places[3 * (t * names.size() + j)])) +
                                    one.places[t].cast<float>();
      const Eigen::Map<const Eigen::Vector3f> said(
          &kinect.positions[3 * (t * fuse_joints.size() + k)]);
      off.push_back(static_cast<double>((said - place).norm()));
    }
  }
  std::sort(off.begin(), off.end());
  return {off[off.size() / 2],
          static_cast<double>(off.size()) / static_cast<double>(one.frames() * fuse_joints.size())};
}

}  // namespace

TEST_CASE("a simulated Kinect sees most joints within centimetres, in the world of the nodes") {
  const FuseData data = swinging_before_kinect(120);
  const Seen seen = seen_of(data.pose.body, data.pose.learnt[0], data.learnt[0][0]);
  CHECK(seen.median > 0.005);
  CHECK(seen.median < 0.09);
  CHECK(seen.tracked > 0.5);
}

TEST_CASE("another take is another draw, the same take the same") {
  const FuseData data = swinging_before_kinect();
  const auto draw = [&](std::uint64_t take) {
    return simulated_kinect(data.pose.body, data.pose.learnt[0], 1, 1, take).positions;
  };
  CHECK(draw(1) == data.learnt[0][0].positions);
  CHECK(draw(1) != draw(2));
}
