// SPDX-License-Identifier: Apache-2.0
// Which units are recognised as wrong, and which are accepted.
#include "kinalign/check/value_survey.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

constexpr std::size_t rows = 40;

/// The findings about the joints of a person of 1.7 m who walks away, in a file whose unit is taken
/// for `metres`.
std::string judged_person(double metres, std::size_t joints = 25) {
  PointFrames block;
  for (std::size_t t = 0; t < rows; ++t) {
    block.stamps.push_back(utc_time(static_cast<std::int64_t>(t)));
    for (std::size_t j = 0; j < joints; ++j) {
      const double height = 1.7 * static_cast<double>(j) / static_cast<double>(joints - 1);
      const double values[] = {0.0, height, 0.1 * static_cast<double>(t)};
      for (const double value : values) block.positions.push_back(value * metres);
      block.state.push_back(Tracking::tracked);
    }
  }
  PointSizes sizes;
  sizes.add(block);
  const Findings findings = sizes.judge({}, "k.csv");
  return findings.empty() ? "" : to_string(findings[0].what) + "; " + findings[0].meaning;
}

/// The findings about nodes that read `acceleration` (m/s2, up and down by a third of itself) and
/// `rate` (rad/s).
std::string judged_node(double acceleration, double rate, bool gravity, double swing = 0.3) {
  ImuSamples block;
  for (std::size_t t = 0; t < rows; ++t) {
    block.stamps.push_back(utc_time(static_cast<std::int64_t>(t)));
    const double a = acceleration * (1.0 + swing * std::sin(static_cast<double>(t)));
    block.acceleration.insert(block.acceleration.end(), {0.0, a, 0.0});
    block.angular_velocity.insert(block.angular_velocity.end(), {rate, 0.0, 0.0});
    block.valid.push_back(1);
  }
  ImuSizes sizes;
  sizes.add(block);
  const Findings findings = sizes.judge({{"waist"}, {false, true, true, gravity}}, "w.csv");
  std::string all;
  for (const Finding& finding : findings) all += to_string(finding.what) + "\n";
  return all;
}

}  // namespace

TEST_CASE("joints of a person who is a kilometre or a millimetre tall are in another unit") {
  CHECK(judged_person(1.0).empty());
  CHECK(judged_person(0.5).empty());  // a child
  CHECK(judged_person(1000.0) ==
        "k.csv: expected the points of a frame 0.2 to 20 m apart, found 1700 m; lengths are "
        "about 1000 times too large");
  CHECK(judged_person(0.01) ==
        "k.csv: expected the points of a frame 0.2 to 20 m apart, found 0.017 m; lengths are about "
        "100 times too small");
  CHECK(judged_person(0.0) ==
        "k.csv: expected the points of a frame 0.2 to 20 m apart, found 0 m; they all lie in one "
        "place");
}

TEST_CASE("fewer points than a person has may be near to each other, not a kilometre apart") {
  CHECK(judged_person(0.01, 9).empty());
  CHECK(judged_person(1000.0, 2) ==
        "k.csv: expected the points of a frame 0.2 to 20 m apart, found 1700 m; lengths are about "
        "1000 times too large");
}

/// The findings about a hip and a hand, frame by frame. The hip sways along z by `hip_sways` m a
/// frame.
template <class Hand>
std::string judged_hand(Hand hand, const Vec3& hip = {0.0, 0.9, 2.0}, double hip_sways = 0.0) {
  PointFrames block;
  for (std::size_t t = 0; t < rows; ++t) {
    block.stamps.push_back(utc_time(static_cast<std::int64_t>(t)));
    const double sway = hip_sways * static_cast<double>(t % 20 < 10 ? t % 10 : 10 - t % 10);
    const Vec3 moved = hip + Vec3(0.0, 0.0, sway);
    for (const Vec3& at : {moved, hand(t)}) {
      block.positions.insert(block.positions.end(), at.begin(), at.end());
      block.state.push_back(Tracking::tracked);
    }
  }
  PointSizes sizes;
  sizes.add(block);
  std::string all;
  for (const Finding& finding : sizes.judge({{"Hip", "Hand"}}, "k.csv")) {
    all += to_string(finding.what) + "; " + finding.repair + "\n";
  }
  return all;
}

std::string zeros_of_hand(const std::string& count) {
  return "k.csv: expected points at measured positions, found " + count +
         " at exactly 0, 0, 0, the first of 'Hand'; if 0, 0, 0 means not seen, set missing_point = "
         "[0, 0, 0] in a layout\n";
}

const Vec3 zero = Vec3::Zero(), in_front{0.4, 1.0, 2.0};

TEST_CASE("zeros that come and go mark what was not seen, at a file's start too") {
  CHECK(judged_hand([](auto t) { return t % 7 == 0 ? zero : in_front; }) == zeros_of_hand("6"));
  CHECK(judged_hand([](auto t) { return t < 30 ? zero : in_front; }) == zeros_of_hand("30"));
  CHECK(judged_hand([](auto t) { return t >= 30 ? zero : in_front; }) == zeros_of_hand("10"));
}

TEST_CASE("zeros among the joints of a hand, all near its wrist, mark what was not seen") {
  CHECK(judged_hand([](auto t) { return t / 10 == 2 ? zero : Vec3(0.0, 0.06, 0.0); }, zero) ==
        zeros_of_hand("10"));
}

TEST_CASE("one point that stays at zero or moves away and comes back is the file's origin") {
  CHECK(judged_hand([](auto) { return in_front; }, zero) == "");
  CHECK(judged_hand([](auto) { return in_front; }, zero, 0.01) == "");
  const auto never = [](auto) { return zero; };
  CHECK(judged_hand(never) == "");
  CHECK(judged_hand(never, zero) ==
        "k.csv: expected points at measured positions, found 80 at exactly 0, 0, 0, the first of "
        "'Hip'; if 0, 0, 0 means not seen, set missing_point = [0, 0, 0] in a layout\n");
}

TEST_CASE("points of which none was tracked are a warning, one that was never seen is a note") {
  PointFrames block;
  for (std::size_t t = 0; t < rows; ++t) {
    block.stamps.push_back(utc_time(static_cast<std::int64_t>(t)));
    block.positions.insert(block.positions.end(), {0, 0, 0, 0, 0.9, 2, 0, 1.6, 2});
    block.state.insert(block.state.end(),
                       {Tracking::missing, Tracking::inferred, Tracking::inferred});
  }
  PointSizes sizes;
  sizes.add(block);
  const Findings found = sizes.judge({{"Hip", "Neck", "Head"}}, "k.csv");
  REQUIRE(found.size() == 2);
  CHECK(found[0].severity == Severity::warning);
  CHECK(to_string(found[0].what) ==
        "k.csv: expected points that were tracked, found none, but 80 inferred points");
  CHECK(found[1].severity == Severity::note);
  CHECK(to_string(found[1].what) ==
        "k.csv: expected points that were seen at least once, found 1 of 3 never seen, the first "
        "is 'Hip'");
}

TEST_CASE("points far from all others mark what was not seen") {
  const Vec3 mark(-9999, -9999, -9999);
  CHECK(
      judged_hand([&](auto t) { return t % 7 == 0 ? mark : in_front; }) ==
      "k.csv: expected the points of a frame within 20 m, found 6 of 40 frames with points farther "
      "apart, 17320 m on average; if a number means not seen, set missing_point in a layout\n");
}

TEST_CASE("accelerations in g, or with gravity where none should be, are distinguished from m/s2") {
  CHECK(judged_node(9.81, 1.0, true).empty());
  CHECK(judged_node(20.0, 5.0, true).empty());  // a shank that runs
  CHECK(judged_node(1.0, 1.0, true) ==
        "w.csv: expected accelerations with gravity of 6 to 40 m/s2 on average, found 1.01 m/s2\n");
  CHECK(judged_node(96.0, 1.0, true) ==
        "w.csv: expected accelerations with gravity of 6 to 40 m/s2 on average, found 96.8 m/s2\n");
  CHECK(judged_node(2.0, 1.0, false).empty());
  CHECK(judged_node(9.81, 1.0, false) ==
        "w.csv: expected accelerations without gravity, found 9.89 m/s2 on average\n");
  CHECK(judged_node(9.81, 1.0, false, 2.0).empty());  // jerks of a runner, gravity removed
}

TEST_CASE("turns in degrees per second are distinguished from radians") {
  CHECK(judged_node(9.81, 57.3, true) ==
        "w.csv: expected angular velocities of at most 12 rad/s on average, found 57.3 rad/s\n");
}

TEST_CASE(
    "samples that were not seen are left out; if hardly a sample was seen, a finding says so") {
  PointFrames missing;
  missing.stamps.assign(rows, Time{});
  missing.positions.assign(rows * 75, 0.0);
  missing.state.assign(rows * 25, Tracking::missing);
  PointSizes points;
  points.add(missing);
  const Findings unseen = points.judge({}, "k.csv");
  REQUIRE(unseen.size() == 1);
  CHECK(to_string(unseen[0].what) ==
        "k.csv: expected at least one frame in ten with a point, found 0 of " +
            std::to_string(rows));
  ImuSamples lost;
  lost.stamps.assign(rows, Time{});
  lost.acceleration.assign(rows * 3, 0.0);
  lost.valid.assign(rows, 0);
  ImuSizes nodes;
  nodes.add(lost);
  const ImuHeader header{{"waist"}, {false, true, false, true}};
  const Findings nothing = nodes.judge(header, "w.csv");
  REQUIRE(nothing.size() == 1);
  CHECK(to_string(nothing[0].what) ==
        "w.csv: expected at least one valid sample in ten, found 0 of " + std::to_string(rows));
  lost.acceleration.assign(9 * 3, 0.0);
  lost.valid.assign(9, 0);  // too few to tell
  ImuSizes few;
  few.add(lost);
  CHECK(few.judge(header, "w.csv").empty());
}
