// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/upright_zero.h"

#include "tests/models/pose/pose_people.h"
#include "tests/seeds.h"

#include "kinalign/models/pose/pose_body.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

using Frame = std::vector<Eigen::Matrix3d>;

std::vector<Vec3> positions_of(const PoseBody& body, const std::vector<Vec3>& offsets,
                               const Frame& rotations) {
  std::vector<Vec3> out{Vec3::Zero()};
  for (std::size_t j = 1; j < offsets.size(); ++j) {
    const auto parent = static_cast<std::size_t>(body.skeleton.parents[j]);
    out.push_back(out[parent] + rotations[parent] * offsets[j]);
  }
  return out;
}

Frame random_frame(std::size_t joints, std::mt19937_64& random) {
  Frame out;
  for (std::size_t j = 0; j < joints; ++j) {
    out.push_back(random_turn(random).cast<double>().normalized().toRotationMatrix());
  }
  return out;
}

const std::vector<std::string>& names() {
  static const std::vector<std::string> all = pose_body(test_offsets()).skeleton.joint_names;
  return all;
}

std::size_t joint(std::string_view name) {
  return static_cast<std::size_t>(std::find(names().begin(), names().end(), name) -
                                  names().begin());
}

}  // namespace

TEST_CASE("another zero leaves every joint where it was") {
  const PoseBody body = pose_body(test_offsets());
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    UprightFrames upright(names());
    for (int t = 0; t < 5; ++t) {
      upright.add(random_frame(body.skeleton.joints(), random), Vec3(0.05, 0.6, 0.0));
    }
    const auto turns = upright.turns();
    const auto offsets = turned_offsets(body.skeleton.parents, body.skeleton.rest_offsets, turns);
    const Frame before = random_frame(body.skeleton.joints(), random);
    Frame after = before;
    for (std::size_t j = 0; j < after.size(); ++j) after[j] = before[j] * turns[j];
    const auto here = positions_of(body, body.skeleton.rest_offsets, before);
    const auto there = positions_of(body, offsets, after);
    // Eight products on both sides, each exact to 2e-16 for a body of 2 m. Rotations that differ
    // much have a mean that is less exact.
    for (std::size_t j = 0; j < here.size(); ++j) CHECK((here[j] - there[j]).norm() < 1e-12);
  }
}

TEST_CASE("a person whose pelvis and head were calibrated tilted stands upright afterwards") {
  const std::size_t root = joint("root"), head = joint("head"), thigh = joint("lfemur");
  Frame stand(names().size(), Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d yaw = Eigen::AngleAxisd(1.3, Vec3::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d pelvis = Eigen::AngleAxisd(-0.4, Vec3::UnitX()).toRotationMatrix();
  for (Eigen::Matrix3d& one : stand) one = yaw * one;
  stand[root] = yaw * pelvis;
  stand[head] = yaw * Eigen::AngleAxisd(0.9, Vec3(1, 0, 1).normalized()).toRotationMatrix();
  UprightFrames upright(names());
  upright.add(stand, Vec3::UnitY());
  const auto turns = upright.turns();
  CHECK((stand[root] * turns[root]).col(1).isApprox(Vec3::UnitY(), 1e-14));
  CHECK((stand[root] * turns[root]).isApprox(yaw, 1e-14));
  CHECK((stand[head] * turns[head]).isApprox(stand[root] * turns[root], 1e-14));
  CHECK(turns[thigh].isApprox(Eigen::Matrix3d::Identity()));
}

TEST_CASE("only frames with the head above the root count") {
  UprightFrames upright(names());
  const Frame frame(names().size(), Eigen::Matrix3d::Identity());
  upright.add(frame, Vec3(0.0, 0.5, 0.0));
  upright.add(frame, Vec3(0.17, 0.5, 0.0));  // 18.8 degrees
  upright.add(frame, Vec3(0.19, 0.5, 0.0));  // 20.8 degrees
  upright.add(frame, Vec3(0.0, -0.5, 0.0));
  CHECK(upright.count() == 2);
}
