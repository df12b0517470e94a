// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/skeleton_of_points.h"

#include "tests/models/bodies.h"

#include "kinalign/models/bones.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

struct Cleaned {
  PointBody body{body_joint_names(), kinect_parents_of(body_joint_names())};
  std::vector<float> positions;

  Cleaned(std::size_t frames, std::uint64_t seed) : positions(moving_body(frames, seed).positions) {
    const auto partners = mirror_partners(body.names);
    impose_lengths(body.parents, typical_lengths(body.parents, partners, positions), positions);
  }
};

std::size_t place_of(const Skeleton& skeleton, const std::string& name) {
  return *index_of(skeleton.joint_names, name);
}

}  // namespace

TEST_CASE("skeleton of points: forward kinematics gives the points back") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    Cleaned cleaned(12, seed);
    turn_and_move(cleaned.positions, 0.7 * static_cast<double>(seed), {2.0F, 0.0F, 3.0F});
    const auto clip = skeleton_of_points(cleaned.body, cleaned.positions, utc_time(5), 30.0);
    REQUIRE(clip);
    REQUIRE(validate(clip->skeleton));
    const std::size_t joints = clip->skeleton.joints(), points = cleaned.body.names.size();
    std::vector<double> global(12 * joints * 3);
    forward_kinematics(clip->skeleton, clip->frames, global);
    for (std::size_t t = 0; t < 12; ++t) {
      for (std::size_t j = 0; j < points; ++j) {
        const std::size_t at = place_of(clip->skeleton, cleaned.body.names[j]);
        for (std::size_t k = 0; k < 3; ++k) {
          const auto wanted = static_cast<double>(cleaned.positions[(t * points + j) * 3 + k]);
          // Bone lengths are those of the first frame. Five bones lead to a hand, each with float's
          // rounding of 3e-7 m.
          CHECK(std::abs(global[(t * joints + at) * 3 + k] - wanted) < 2e-6);
        }
      }
    }
  }
}

TEST_CASE("skeleton of points: bones are constant, rotations are of length 1, stamps are even") {
  const Cleaned cleaned(4, 3);
  const auto clip = skeleton_of_points(cleaned.body, cleaned.positions, utc_time(1000), 30.0);
  REQUIRE(clip);
  const std::size_t joints = clip->skeleton.joints();
  for (std::size_t i = joints; i < 4 * joints; ++i) {
    if (clip->skeleton.parents[i % joints] < 0) continue;
    CHECK(vec3(clip->frames.local_positions, i) == vec3(clip->frames.local_positions, i % joints));
  }
  for (std::size_t i = 0; i < 4 * joints; ++i) {
    CHECK(quat(clip->frames.local_rotations, i).norm() == doctest::Approx(1.0).epsilon(1e-12));
  }
  const std::vector<std::int64_t> wanted{1000, 33'334'333, 66'667'667, 100'001'000};
  for (std::size_t t = 0; t < 4; ++t) CHECK(to_ns(clip->frames.stamps[t]) == wanted[t]);
}

TEST_CASE("skeleton of points: the rest pose is a T-pose that faces +z") {
  const Cleaned cleaned(1, 3);
  const auto clip = skeleton_of_points(cleaned.body, cleaned.positions, utc_time(0), 30.0);
  REQUIRE(clip);
  const auto offset = [&](const char* name) {
    return clip->skeleton.rest_offsets[place_of(clip->skeleton, name)].normalized().eval();
  };
  CHECK(offset("ElbowLeft") == Vec3::UnitX());
  CHECK(offset("WristRight") == Vec3(-Vec3::UnitX()));
  CHECK(offset("KneeLeft") == Vec3(-Vec3::UnitY()));
  CHECK(offset("FootLeft") == Vec3::UnitZ());
  CHECK(offset("Head") == Vec3::UnitY());
}

TEST_CASE("skeleton of points: a suit's joints have the same rest pose, fingers go on") {
  const PointBody body{{"Hips", "Spine", "Spine3", "LeftShoulder", "LeftArm", "LeftForeArm",
                        "LeftHand", "LeftHandThumb1", "RightUpLeg", "RightLeg"},
                       {-1, 0, 1, 2, 3, 4, 5, 6, 0, 8}};
  const std::vector<float> positions{0,    1,    0,    0,    1.2F,  0,    0, 1.4F,  0,    0.1F,
                                     1.4F, 0.1F, 0.2F, 1.3F, 0,     0.2F, 1, 0,     0.3F, 0.8F,
                                     0,    0.3F, 0.7F, 0,    -0.1F, 1,    0, -0.1F, 0.5F, 0};
  const auto clip = skeleton_of_points(body, positions, utc_time(0), 30.0);
  REQUIRE(clip);
  const auto offset = [&](const char* name) {
    return clip->skeleton.rest_offsets[place_of(clip->skeleton, name)].normalized().eval();
  };
  CHECK(offset("Spine") == Vec3::UnitY());
  for (const char* name : {"LeftShoulder", "LeftArm", "LeftForeArm", "LeftHandThumb1"}) {
    CHECK(offset(name) == Vec3::UnitX());
  }
  CHECK(offset("RightUpLeg") == Vec3(-Vec3::UnitX()));
  CHECK(offset("RightLeg") == Vec3(-Vec3::UnitY()));
}

TEST_CASE("skeleton of points: a joint with several children has one more joint for each") {
  const PointBody body{{"SpineBase", "HipLeft", "HipRight", "KneeLeft"}, {-1, 0, 0, 1}};
  const std::vector<float> positions{0, 1, 0, 0.1F, 1, 0, -0.1F, 1, 0, 0.1F, 0.5F, 0};
  const auto clip = skeleton_of_points(body, positions, utc_time(0), 30.0);
  REQUIRE(clip);
  const std::vector<std::string> names{"SpineBase",    "HipLeftRoot", "HipLeft",
                                       "HipRightRoot", "HipRight",    "KneeLeft"};
  CHECK(clip->skeleton.joint_names == names);
  CHECK(clip->skeleton.parents == std::vector<int>{-1, 0, 1, 0, 3, 2});
}

TEST_CASE("skeleton of points: joints in one place give a pose all the same") {
  const PointBody body{{"SpineBase", "SpineMid", "Neck"}, {-1, 0, 1}};
  const auto clip = skeleton_of_points(body, std::vector<float>(18, 1.0F), utc_time(0), 30.0);
  REQUIRE(clip);
  for (const double value : clip->frames.local_rotations) CHECK(std::isfinite(value));
}

TEST_CASE("skeleton of points: parents must be one tree") {
  const auto refusal = [](std::vector<int> parents) {
    const PointBody body{std::vector<std::string>(parents.size(), "a"), std::move(parents)};
    const auto clip = skeleton_of_points(body, {}, utc_time(0), 30.0);
    return clip ? "no error" : to_string(clip.error());
  };
  CHECK(refusal({-1, -1}) == "expected joints that hang on one root, found 2 roots");
  CHECK(refusal({1, 0}) == "expected joints that hang on one root, found 0 roots");
  CHECK(refusal({-1, 2, 1}) == "expected joints in a tree, found a circle");
}
