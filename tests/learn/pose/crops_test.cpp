// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/crops.h"

#include "tests/learn/pose/swinging.h"

#include "kinalign/learn/pose/pose_task.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

constexpr double rate_hz = 30.0;

Sides sides_of(const PoseData& data) { return {data.body, data.nodes, {"KneeLeft", "KneeRight"}}; }

/// A body that sways and turns about one axis. Its waist's node follows from closed formulas.
PoseSequence swaying(std::size_t frames) {
  PoseSequence out = swinging(frames, 4);
  const Eigen::Vector3f axis = Eigen::Vector3f(0.3F, 0.8F, -0.5F).normalized();
  const double w = 2.0;  // rad/s
  for (std::size_t t = 0; t < frames; ++t) {
    const double at = static_cast<double>(t) / rate_hz;
    out.places[t] = {0.4 * std::sin(w * at), 1.0 + 0.1 * std::cos(w * at), 0.3 * std::cos(w * at)};
    const std::size_t n = t * out.nodes.nodes + out.nodes.nodes - 1;
    const Vec3 acceleration = -w * w * (out.places[t] - Vec3::UnitY());
    const Eigen::Vector3f rate = static_cast<float>(0.7 * w * std::cos(w * at)) * axis;
    const Eigen::Quaternionf turn(
        Eigen::AngleAxisf(static_cast<float>(0.7 * std::sin(w * at)), axis));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      out.nodes.acceleration[3 * n + k] = static_cast<float>(acceleration[i]);
      out.nodes.angular_velocity[3 * n + k] = rate[i];
    }
    const std::array<float, 4> wxyz{turn.w(), turn.x(), turn.y(), turn.z()};
    std::copy(wxyz.begin(), wxyz.end(),
              out.nodes.orientation.begin() + static_cast<std::ptrdiff_t>(4 * n));
  }
  return out;
}

Vec3 waist_vector(const std::vector<float>& values, const NodeFrames& nodes, std::size_t t) {
  const float* at = &values[3 * (t * nodes.nodes + nodes.nodes - 1)];
  return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

std::vector<float> positions_of(const PoseSequence& one, const PoseBody& body) {
  return bone_positions(body, one.rest_offsets, one.rotations);
}

}  // namespace

TEST_CASE("a crop that is not varied holds the sequence's frames, the last one again and again") {
  const PoseData data = swinging_data();
  const PoseSequence& whole = data.learnt[0];
  const PoseSequence crop = crop_of(whole, {.begin = 20, .count = 6}, sides_of(data));
  REQUIRE(crop.frames() == 6);
  const std::size_t bones = pose_bones.size();
  for (std::size_t t = 0; t < 6; ++t) {
    const std::size_t from = std::min<std::size_t>(20 + t, 23);
    for (std::size_t b = 0; b < bones; ++b) {
      CHECK(crop.rotations[t * bones + b] == whole.rotations[from * bones + b]);
    }
    for (std::size_t k = 0; k < 3 * 5; ++k) {
      CHECK(crop.nodes.acceleration[t * 15 + k] == whole.nodes.acceleration[from * 15 + k]);
      CHECK(crop.nodes.angular_velocity[t * 15 + k] == whole.nodes.angular_velocity[from * 15 + k]);
    }
  }
  CHECK(crop.rest_offsets == whole.rest_offsets);
}

TEST_CASE("a mirrored crop is the person in a mirror") {
  const PoseData data = swinging_data();
  const Sides sides = sides_of(data);
  const PoseSequence& whole = data.learnt[0];
  const Crop crop{.begin = 0, .count = 24, .variation = {.mirrored = true}};
  const PoseSequence mirrored = crop_of(whole, crop, sides);
  std::vector<float> expected = positions_of(whole, data.body);
  mirror_positions(expected, sides.joints);
  const std::vector<float> found = positions_of(mirrored, data.body);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(std::abs(found[i] - expected[i]) < 1e-5F);
  // The node of the left wrist is on the left forearm again, which was the right one before the
  // mirroring.
  const std::size_t forearm = 11;
  for (std::size_t t = 0; t < 24; ++t) {
    const auto node = orientation_at(mirrored.nodes, t, 0);
    REQUIRE(node);
    const Turn& bone = mirrored.rotations[t * pose_bones.size() + forearm];
    CHECK((node->toRotationMatrix() - bone).norm() < 1e-4F);
  }
  const PoseSequence back = crop_of(mirrored, crop, sides);
  CHECK(back.nodes.acceleration == whole.nodes.acceleration);
  CHECK(back.rest_offsets == whole.rest_offsets);
}

TEST_CASE("rates and accelerations of a varied crop are those of its orientations and places") {
  const PoseData data = swinging_data();
  for (const bool mirrored : {false, true}) {
    const Crop crop{.begin = 3, .count = 60, .variation = {mirrored, 1.2, 0.9}};
    const PoseSequence one = crop_of(swaying(120), crop, sides_of(data));
    for (std::size_t t = 1; t + 1 < 60; ++t) {
      const Vec3 bend =
          (one.places[t - 1] - 2.0 * one.places[t] + one.places[t + 1]) * rate_hz * rate_hz;
      const auto acceleration = waist_vector(one.nodes.acceleration, one.nodes, t);
      // Up to 2.3 m/s2 is true; positions are interpolated.
      CHECK((bend - acceleration).norm() < 0.5);
      const auto before = orientation_at(one.nodes, t - 1, 4),
                 after = orientation_at(one.nodes, t + 1, 4);
      REQUIRE(before);
      REQUIRE(after);
      const Eigen::AngleAxisf turn(before->conjugate() * *after);
      const Vec3 rate = rate_hz / 2.0 * (turn.angle() * turn.axis()).cast<double>();
      CHECK((rate - waist_vector(one.nodes.angular_velocity, one.nodes, t)).norm() < 0.03);
    }
  }
}

TEST_CASE("a faster crop covers more frames, and each of its moments is the sequence's") {
  const PoseData data = swinging_data();
  const Crop crop{.begin = 2, .count = 11, .variation = {.speed = 1.5}};
  CHECK(crop.source_frames() == 16);
  const PoseSequence whole = swaying(40), one = crop_of(whole, crop, sides_of(data));
  CHECK(one.places[4] == whole.places[8]);
  CHECK((one.places[5] - 0.5 * (whole.places[9] + whole.places[10])).norm() < 1e-12);
}

TEST_CASE("a Kinect's joint is there where it is in both frames") {
  const PoseData data = swinging_data();
  const JointFrames kinect{.joints = 2,
                           .positions = {1, 2, 3, -1, 2, 3, 2, 2, 3, 0, 0, 0, 3, 2, 3, 1, 2, 3},
                           .seen = {2, 1, 2, 0, 2, 2}};
  const Crop crop{
      .begin = 0, .count = 3, .variation = {.mirrored = true, .speed = 0.5, .size = 2.0}};
  const JointFrames out = crop_of(kinect, crop, sides_of(data));
  CHECK(out.seen == std::vector<std::uint8_t>{1, 2, 0, 2, 0, 2});
  CHECK(out.positions ==
        std::vector<float>{2, 4, 6, -2, 4, 6, 0, 0, 0, -3, 4, 6, 0, 0, 0, -4, 4, 6});
}

TEST_CASE("half of the crops are mirrored, speeds and sizes stay within their bounds") {
  const PoseData data = swinging_data();
  const CropDraws draws({swinging(300, 1)}, sides_of(data));
  std::size_t mirrored = 0;
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const Crop crop = draws.draw({1, k}, 64, {0.5, 0.2, 0.1}).crop;
    mirrored += crop.variation.mirrored ? 1 : 0;
    CHECK(crop.variation.speed >= 1.0 / 1.2);
    CHECK(crop.variation.speed <= 1.2);
    CHECK(crop.variation.size >= 1.0 / 1.1);
    CHECK(crop.variation.size <= 1.1);
    CHECK(crop.begin + crop.source_frames() <= 300);
  }
  CHECK(mirrored > 430);
  CHECK(mirrored < 570);
}

TEST_CASE("where a node has no partner on the other side, no crop is mirrored") {
  const PoseData data = swinging_data();
  const Sides sides(data.body, {"wrist_left", "ankle_left", "ankle_right", "waist"}, {});
  CHECK(!sides.can_mirror);
  const CropDraws draws({swinging(300, 1)}, sides);
  for (std::uint64_t k = 0; k < 100; ++k)
    CHECK(!draws.draw({1, k}, 64, {}).crop.variation.mirrored);
}
