// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/body_frame.h"

#include "tests/models/bodies.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

BodyJoints joints() { return *body_joints(body_joint_names()); }

/// One joint over frames; NaN: not seen.
JointFrames one_joint(const std::vector<float>& x) {
  JointFrames out{1, {}, {}};
  for (const float value : x) {
    const bool seen = !std::isnan(value);
    out.positions.insert(out.positions.end(), {seen ? value : 0.0F, 0.0F, 0.0F});
    out.seen.push_back(seen ? 2 : 0);
  }
  return out;
}

std::vector<float> filled(const std::vector<float>& x, bool causal) {
  JointFrames body = one_joint(x);
  fill_missing(body, causal);
  std::vector<float> out;
  for (std::size_t i = 0; i < body.positions.size(); i += 3) out.push_back(body.positions[i]);
  return out;
}

}  // namespace

TEST_CASE("body frame: root and sides are found by the names of each style") {
  const auto kinect = body_joints({"SpineBase", "HipLeft", "HipRight"});
  REQUIRE(kinect);
  CHECK(kinect->root == std::vector<std::size_t>{0});
  CHECK(kinect->left_right == std::vector<std::array<std::size_t, 2>>{{1, 2}});
  CHECK(body_joints({"Hips", "LeftUpLeg", "RightUpLeg"}));
  CHECK(body_joints({"Waist", "UpperLegLeft", "UpperLegRight"}));
  CHECK(body_joints({"root", "lfemur", "rfemur"}));
  const auto hips = body_joints({"RightHip", "LeftHip"});  // no root: the middle of both hips
  REQUIRE(hips);
  CHECK(hips->root == std::vector<std::size_t>{1, 0});
  CHECK_FALSE(body_joints({"SpineBase", "Head"}));
  CHECK_FALSE(body_joints({"ShoulderLeft", "ShoulderRight"}));  // sides, but no root joint
  CHECK_FALSE(body_joints({}));
}

TEST_CASE("body frame: a body that faces +z has the axes of the world") {
  const auto frames = body_frames(joints(), moving_body(1, 1));
  CHECK(std::abs(frames[0].root[1] - 0.95F) <= 0.0501F);
  JointFrames body{standing_body.size(), {}, std::vector<std::uint8_t>(standing_body.size(), 2)};
  for (const auto& joint : standing_body) {
    body.positions.insert(body.positions.end(), joint.begin(), joint.end());
  }
  const auto standing = body_frames(joints(), body);
  CHECK(standing[0].cosine == 1.0F);
  CHECK(standing[0].sine == 0.0F);
  CHECK(standing[0].root == standing_body[0]);
}

TEST_CASE("body frame: a turned and moved body has the turned and moved frame") {
  for (int step = 0; step < 24; ++step) {
    const double angle = 2.0 * M_PI * step / 24.0;
    CAPTURE(angle);
    JointFrames body = moving_body(10, 3);
    const auto before = body_frames(joints(), body);
    turn_and_move(body.positions, angle, {1.0F, 0.5F, -2.0F});
    const auto after = body_frames(joints(), body);
    for (std::size_t t = 0; t < before.size(); ++t) {
      std::vector<float> root(before[t].root.begin(), before[t].root.end());
      turn_and_move(root, angle, {1.0F, 0.5F, -2.0F});
      std::vector<float> left{before[t].cosine, 0.0F, before[t].sine};
      turn_and_move(left, angle, {});
      for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(after[t].root[k] - root[k]) < 1e-5F);
      CHECK(std::abs(after[t].cosine - left[0]) < 1e-5F);
      CHECK(std::abs(after[t].sine - left[2]) < 1e-5F);
    }
  }
}

TEST_CASE("body frame: a body seen from the side keeps its heading") {
  JointFrames body = moving_body(30, 5);
  for (std::size_t t = 0; t < 30; ++t) {
    if (t >= 5 && t < 20) continue;
    for (std::size_t j = 0; j < body.joints; ++j) {  // both sides are at one place
      float* at = &body.positions[(t * body.joints + j) * 3];
      at[0] *= 0.05F;
      at[2] *= 0.05F;
    }
  }
  const auto frames = body_frames(joints(), body);
  for (std::size_t t = 0; t < 30; ++t) {
    const std::size_t same = t < 5 ? 5 : t >= 20 ? 19 : t;  // the first and the last known one
    CHECK(frames[t].cosine == frames[same].cosine);
    CHECK(frames[t].sine == frames[same].sine);
  }
  CHECK(frames[10].sine != frames[11].sine);
}

TEST_CASE("body frame: where no frame shows the sides the heading is the world's") {
  JointFrames body = moving_body(3, 5);
  std::fill(body.positions.begin(), body.positions.end(), 0.0F);
  for (const BodyFrame& frame : body_frames(joints(), body)) {
    CHECK(frame.cosine == 1.0F);
    CHECK(frame.sine == 0.0F);
  }
}

TEST_CASE("fill_missing: a line between seen frames, held at the ends") {
  CHECK(filled({NAN, 2, NAN, NAN, 8, NAN}, false) == std::vector<float>{2, 2, 4, 6, 8, 8});
  CHECK(filled({1, 2, 3}, false) == std::vector<float>{1, 2, 3});
}

TEST_CASE("fill_missing: causal, a joint stays until it is seen again") {
  CHECK(filled({NAN, 2, NAN, NAN, 8, NAN}, true) == std::vector<float>{2, 2, 2, 2, 8, 8});
}

TEST_CASE("fill_missing: a joint that is never seen lies at the mean of the others") {
  JointFrames body{3, {0, 0, 0, 2, 4, 6, 4, 0, 2}, {0, 2, 1}};
  fill_missing(body, false);
  CHECK(body.positions == std::vector<float>{3, 2, 4, 2, 4, 6, 4, 0, 2});
  JointFrames none{2, {0, 0, 0, 0, 0, 0}, {0, 0}};
  fill_missing(none, false);
  CHECK(none.positions == std::vector<float>(6, 0.0F));
}
