// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/bone_filter.h"

#include "tests/models/fuse/fuse_people.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace kinalign;

namespace {

/// Mean distance of joints from the truth about the root, cm, in the world, for frames from `begin`
/// on.
double error_cm(const FusePerson& person, const FusedPose& answer, std::string_view joint,
                std::size_t begin, std::size_t end) {
  const PoseBody body = pose_body(test_offsets());
  const auto& names = body.skeleton.joint_names;
  const auto j =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), joint) - names.begin());
  const auto places = [&](const FusedPose& pose) {
    return bone_positions(body, body.skeleton.rest_offsets, pose.rotations);
  };
  const auto said = places(answer), real = places(person.truth);
  double sum = 0.0;
  for (std::size_t t = begin; t < end; ++t) {
    const std::size_t at = 3 * (t * names.size() + j);
    const Eigen::Vector3f a =
        answer.root[t] * Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(&said[at]));
    const Eigen::Vector3f b =
        person.truth.root[t] * Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(&real[at]));
    sum += 100.0 * static_cast<double>((a - b).norm());
  }
  return sum / static_cast<double>(end - begin);
}

}  // namespace

TEST_CASE("with clean devices the filter finds hands and feet within 5 cm") {
  const FusePerson person = fuse_person(120);
  const FusedPose pose = filtered_pose(fuse_test_layout(), pose_body(test_offsets()), person.input);
  for (const char* joint : {"lhand", "rhand", "lfoot", "rfoot", "ltibia", "lradius"}) {
    CAPTURE(joint);
    CHECK(error_cm(person, pose, joint, 10, 110) < 5.0);
  }
}

TEST_CASE("a forearm that the Kinect loses goes on with its node") {
  FusePerson person = fuse_person(120);
  const FuseLayout layout = fuse_test_layout();
  const auto lose = [&](std::string_view name) {
    const auto j = static_cast<std::size_t>(
        std::find(layout.joints.begin(), layout.joints.end(), name) - layout.joints.begin());
    for (std::size_t t = 40; t < 100; ++t)
      person.input.kinect.seen[t * layout.joints.size() + j] = 0;
  };
  lose("WristLeft");
  lose("HandLeft");
  const PoseBody body = pose_body(test_offsets());
  const double with_nodes =
      error_cm(person, filtered_pose(layout, body, person.input), "lhand", 45, 95);
  lose_all(person.input.nodes.valid);
  const double alone = error_cm(person, filtered_pose(layout, body, person.input), "lhand", 45, 95);
  CHECK(with_nodes < 5.0);
  CHECK(alone > 1.5 * with_nodes);
}

TEST_CASE("a limb that the Kinect puts elsewhere is left to its node") {
  FusePerson person = fuse_person(120);
  const FuseLayout layout = fuse_test_layout();
  for (std::size_t t = 40; t < 80; ++t) {
    float* wrist = &person.input.kinect.positions[3 * (t * layout.joints.size() + 6)];
    wrist[1] += 0.4F;
  }
  const FusedPose pose = filtered_pose(layout, pose_body(test_offsets()), person.input);
  CHECK(error_cm(person, pose, "lhand", 50, 70) < 6.0);
}

TEST_CASE("rotations stay rotations over a long time") {
  const FusePerson person = fuse_person(3000);
  const FusedPose pose = filtered_pose(fuse_test_layout(), pose_body(test_offsets()), person.input);
  for (const Turn& turn : pose.rotations) {
    REQUIRE((turn.transpose() * turn - Turn::Identity()).norm() < 1e-4F);
  }
}
