// SPDX-License-Identifier: Apache-2.0
// Rules for any skeleton, and a check that no array of a block of frames is forgotten.
#include "tests/motion/chains.h"
#include "tests/seeds.h"

#include "kinalign/motion/clip.h"
#include "kinalign/motion/frame_arrays.h"

#include <doctest/doctest.h>

#include <set>
#include <tuple>

using namespace kinalign;

namespace {

template <class Frames>
constexpr std::size_t arrays_told = std::tuple_size_v<decltype(frame_arrays<Frames>)>;

/// Whether `more` of each array is reported, and reported once.
template <class Frames>
void check_each_once(std::size_t members) {
  Frames frames;
  std::set<const void*> told;
  for_each_frame_array<Frames>([&](auto array) { told.insert(&(frames.*array)); });
  CHECK(told.size() == members);
}

}  // namespace

TEST_CASE("what treats the arrays of a block alike treats all of them") {
  // If a member is added or removed, these names no longer fit and this does not compile: then
  // frame_arrays must be changed, too.
  const auto& [clip_stamps, places, rotations] = ClipFrames{};
  static_assert(arrays_told<ClipFrames> == 3);
  check_each_once<ClipFrames>(3);
  const auto& [point_stamps, positions, state] = PointFrames{};
  static_assert(arrays_told<PointFrames> == 3);
  check_each_once<PointFrames>(3);
  const auto& [imu_stamps, orientation, acceleration, angular_velocity, valid] = ImuSamples{};
  static_assert(arrays_told<ImuSamples> == 5);
  check_each_once<ImuSamples>(5);
}

TEST_CASE("a skeleton is valid as long as each parent stands before its child, and no longer") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Skeleton skeleton = random_chain(1 + random() % 40, 0, random).skeleton;
    const std::size_t j = random() % skeleton.joints();
    const auto joints = static_cast<int>(skeleton.joints());
    skeleton.end_sites = {{static_cast<int>(random() % skeleton.joints()), Vec3::Zero()}};
    REQUIRE(validate(skeleton));
    for (int parent = -3; parent <= joints; ++parent) {
      CAPTURE(parent);
      Skeleton other = skeleton;
      other.parents[j] = parent;
      const auto result = validate(other);
      CHECK(result.has_value() == (parent >= -1 && parent < static_cast<int>(j)));
      if (!result) CHECK(result.error().found == "joint '" + other.joint_names[j] + "'");
    }
    for (int parent = -2; parent <= joints; ++parent) {
      Skeleton other = skeleton;
      other.end_sites[0].parent = parent;
      CHECK(validate(other).has_value() == (parent >= 0 && parent < joints));
    }
  }
}

TEST_CASE("a name shared by any two joints is reported") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Skeleton skeleton = random_chain(2 + random() % 40, 0, random).skeleton;
    const std::size_t a = random() % skeleton.joints(), b = random() % skeleton.joints();
    if (a == b) continue;
    skeleton.joint_names[a] = skeleton.joint_names[b];
    const auto result = validate(skeleton);
    REQUIRE(!result);
    CHECK(result.error().found == "'" + skeleton.joint_names[b] + "' twice");
  }
}
