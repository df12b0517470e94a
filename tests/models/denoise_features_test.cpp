// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/denoise_features.h"

#include "tests/models/bodies.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

DenoiseLayout layout() { return *denoise_layout(body_joint_names(), body_joint_names(), 30.0); }

}  // namespace

TEST_CASE("layout: bases and parents by name, whatever style the names have") {
  const auto out =
      denoise_layout(body_joint_names(), {"Hips", "LeftUpLeg", "LeftLeg", "Tail"}, 30.0);
  REQUIRE(out);
  CHECK(out->bases == std::vector<int>{0, 12, 13, -1});
  CHECK(out->parents == std::vector<int>{-1, 0, 1, -1});
  CHECK(out->channels() == 7 * 21);
  CHECK(out->answers() == 12);
  CHECK(out->smoothing.window == 9);  // 0.3 s, rounded to an odd number of frames
  const auto other = denoise_layout({"SpineBase", "Head"}, {"Head"}, 30.0);
  REQUIRE_FALSE(other);
  CHECK(to_string(other.error()) ==
        "expected an input with a root (SpineBase, Hips, ...) and both hips, found 2 joints "
        "without them");
}

TEST_CASE("layout: an output that the Kinect lacks begins at the joint above it") {
  const auto out = denoise_layout(body_joint_names(),
                                  {"Hips", "LeftHand", "LeftHandIndex1", "LeftHandIndex2", "Tail"},
                                  30.0, {-1, 0, 1, 2, -1});
  REQUIRE(out);
  CHECK(out->bases[2] == out->bases[1]);
  CHECK(out->bases[3] == out->bases[1]);
  CHECK(out->inputs[static_cast<std::size_t>(out->bases[1])] == "WristLeft");
  CHECK(out->bases[4] == -1);
  CHECK(inputs_of_outputs(*out)[4] == inputs_of_outputs(*out)[0]);
}

TEST_CASE("features: positions, their differences, and how well joints are seen") {
  JointFrames body = moving_body(20, 1);
  body.seen[5] = 1;
  body.seen[21 + 5] = 0;
  const DenoiseFeatures features = denoise_features(layout(), body);
  REQUIRE(features.input.size() == 20 * 147);
  REQUIRE(features.base.size() == 20 * 63);
  REQUIRE(features.frames.size() == 20);
  for (std::size_t i = 63; i < 126; ++i) CHECK(features.input[i] == 0.0F);  // nothing before
  for (std::size_t t = 1; t < 20; ++t) {
    for (std::size_t i = 0; i < 63; ++i) {
      const float* row = &features.input[t * 147];
      CHECK(row[63 + i] == row[i] - row[static_cast<std::ptrdiff_t>(i) - 147]);
    }
  }
  CHECK(features.input[126 + 4] == 1.0F);
  CHECK(features.input[126 + 5] == 0.5F);
  CHECK(features.input[147 + 126 + 5] == 0.0F);
}

TEST_CASE("features: a body that is turned and moved has the same ones") {
  const JointFrames body = moving_body(20, 4);
  JointFrames other = body;
  turn_and_move(other.positions, 2.0, {3.0F, 0.0F, -1.0F});
  const auto a = denoise_features(layout(), body), b = denoise_features(layout(), other);
  for (std::size_t i = 0; i < a.input.size(); ++i) CHECK(std::abs(a.input[i] - b.input[i]) < 1e-5F);
  for (std::size_t i = 0; i < a.base.size(); ++i) CHECK(std::abs(a.base[i] - b.base[i]) < 1e-5F);
}

TEST_CASE("features: the base of a joint is its smoothed input; without one it is the root") {
  DenoiseLayout one = layout();
  one.bases.assign(21, -1);
  const auto features = denoise_features(one, moving_body(20, 4));
  for (const float value : features.base) CHECK(value == 0.0F);
  const auto with = denoise_features(layout(), moving_body(20, 4));
  for (std::size_t t = 0; t < 20; ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(std::abs(with.base[t * 63 + k]) < 1e-6F);  // SpineBase
  }
}

TEST_CASE("to_body and to_world undo each other") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    JointFrames body = moving_body(9, seed);
    turn_and_move(body.positions, 0.9 * static_cast<double>(seed), {1.0F, 2.0F, 3.0F});
    const auto frames = denoise_features(layout(), body).frames;
    auto positions = body.positions;
    to_body(frames, positions);
    to_world(frames, positions);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      CHECK(std::abs(positions[i] - body.positions[i]) < 2e-6F);
    }
  }
}

TEST_CASE("features: causal, no frame knows a later one") {
  DenoiseLayout causal = layout();
  causal.smoothing.causal = true;
  JointFrames body = moving_body(30, 4);
  for (std::size_t t = 10; t < 14; ++t) body.seen[t * 21 + 6] = 0;
  JointFrames other = body;
  for (std::size_t i = 20 * 63; i < other.positions.size(); ++i) other.positions[i] += 0.1F;
  for (std::size_t i = 12 * 21; i < 13 * 21; ++i) CHECK(other.seen[i] == body.seen[i]);
  const auto a = denoise_features(causal, body), b = denoise_features(causal, other);
  for (std::size_t i = 0; i < 20 * 147; ++i) CHECK(a.input[i] == b.input[i]);
  for (std::size_t i = 0; i < 20 * 63; ++i) CHECK(a.base[i] == b.base[i]);
}
