// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/denoise_marks.h"

#include "tests/about.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;

namespace {

constexpr std::size_t frames = 40;

const std::vector<std::string> suit_names{
    "Hips",         "RightUpLeg", "RightLeg", "RightFoot",   "LeftUpLeg", "LeftLeg", "LeftFoot",
    "Spine",        "Spine1",     "Spine2",   "Spine3",      "Neck",      "Head",    "RightArm",
    "RightForeArm", "RightHand",  "LeftArm",  "LeftForeArm", "LeftHand"};

/// A walk of random joints, and an answer some centimetres off.
struct Drawn {
  Pair pair;
  std::vector<float> answer;
};

Drawn drawn(std::size_t joints) {
  std::mt19937_64 random(7);
  std::normal_distribution<float> step(0.0F, 0.01F);
  Drawn out;
  out.pair.subject = "01";
  out.pair.action = "S1A01";
  std::vector<float> at(3 * joints);
  for (float& x : at) x = 50.0F * step(random);
  for (std::size_t t = 0; t < frames; ++t) {
    for (float& x : at) {
      x += step(random);
      out.pair.truth.push_back(x);
      out.answer.push_back(x + 3.0F * step(random));
    }
  }
  out.pair.valid.assign(frames * joints, 1);
  return out;
}

DenoiseLayout layout_of(const std::vector<std::string>& outputs) {
  DenoiseLayout layout;
  layout.outputs = outputs;
  layout.rate_hz = 30.0;
  return layout;
}

}  // namespace

TEST_CASE("a suit's skeleton without tips of the feet is marked as one whose tips never count") {
  std::vector<std::string> whole_names = suit_names;
  whole_names.insert(whole_names.end(), {"LeftToeBase", "RightToeBase"});
  Drawn whole = drawn(whole_names.size());
  Drawn suit = whole;
  suit.pair.truth.clear();
  suit.pair.valid.clear();
  suit.answer.clear();
  for (std::size_t t = 0; t < frames; ++t) {
    for (std::size_t j = 0; j < whole_names.size(); ++j) {
      const std::size_t cell = t * whole_names.size() + j;
      if (j >= suit_names.size()) {
        whole.pair.valid[cell] = 0;
        continue;
      }
      suit.pair.valid.push_back(1);
      for (std::size_t k = 0; k < 3; ++k) {
        suit.pair.truth.push_back(whole.pair.truth[3 * cell + k]);
        suit.answer.push_back(whole.answer[3 * cell + k]);
      }
    }
  }
  const auto of_whole = DenoiseMarker::make(layout_of(whole_names), {whole.pair});
  const auto of_suit = DenoiseMarker::make(layout_of(suit_names), {suit.pair});
  REQUIRE(of_whole);
  REQUIRE(of_suit);
  const ProtocolMarks a = of_whole->marks_of(whole.pair, whole.answer, {}).protocol;
  const DenoiseMarks marks = of_suit->marks_of(suit.pair, suit.answer, {});
  const ProtocolMarks& b = marks.protocol;
  CHECK(*a.position_cm == about(*b.position_cm));
  CHECK(*a.fitted_cm == about(*b.fitted_cm));
  CHECK(*a.bone_cm == about(*b.bone_cm));
  CHECK(*a.constancy_cm == about(*b.constancy_cm));
  CHECK(a.acceleration_mm == about(b.acceleration_mm));
  CHECK(a.jitter_mm == about(b.jitter_mm));
  // E_p is the mean square of a coordinate's error: 3 cm on each axis, no zeros of missing joints.
  CHECK(marks.table_nine.position == doctest::Approx(9.0).epsilon(0.15));
}

TEST_CASE("a truth of too few shared joints is refused with their number") {
  const std::vector<std::string> names{"Hips", "LeftUpLeg", "RightUpLeg", "Head", "Tail"};
  const auto marker = DenoiseMarker::make(layout_of(names), {});
  REQUIRE_FALSE(marker);
  CHECK(to_string(marker.error()) ==
        "expected at least 12 of the 18 joints that the Kinect and the truth have in common, found "
        "4 among 5");
}

TEST_CASE("wrists and standing feet have marks of their own") {
  const std::size_t joints = suit_names.size(), left_foot = 6, left_hand = 18;
  Drawn still = drawn(joints);
  for (std::size_t i = 3 * joints; i < still.pair.truth.size(); ++i) {
    still.pair.truth[i] = still.pair.truth[i - 3 * joints];
  }
  still.answer = still.pair.truth;
  for (std::size_t t = 0; t < frames; ++t) {
    still.answer[(t * joints + left_hand) * 3] += 0.06F;
    still.answer[(t * joints + left_foot) * 3] += 0.01F * static_cast<float>(t);
  }
  const auto marker = DenoiseMarker::make(layout_of(suit_names), {still.pair});
  REQUIRE(marker);
  const DenoiseMarks marks = marker->marks_of(still.pair, still.answer, {});
  REQUIRE(marks.hand_cm);
  CHECK(*marks.hand_cm == doctest::Approx(3.0).epsilon(1e-4));  // one of the two wrists is 6 cm off
  // Both ankles stand; one of them slides by 1 cm a frame at 30 Hz.
  CHECK(marks.feet.contacts == 2 * (frames - 1));
  CHECK(marks.feet.skate_m_s == doctest::Approx(0.15).epsilon(1e-3));
  CHECK(marks.feet.true_skate_m_s == 0.0);
}
