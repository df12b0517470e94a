// SPDX-License-Identifier: Apache-2.0
// A node whose orientations fit its other data gives no finding; if they do not, the finding says
// which part is wrong.
#include "kinalign/check/orientation_sense.h"

#include "kinalign/motion/arrays.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

using namespace kinalign;

namespace {

constexpr double step_s = 0.01;
using Change = std::function<Quat(const Quat&)>;

Quat as_it_is(const Quat& q) { return q; }
Quat parts_shifted(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }  // x,y,z,w as w,x,y,z
Quat other_way(const Quat& q) { return q.conjugate(); }
Quat z_up(const Quat& q) { return Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0) * q; }

/// A node that swings, `times` as far. Its acceleration and rates follow from its true orientations
/// (gravity, and the turn from one to the next); the orientations that it states are changed by
/// `change`.
ImuSamples swinging(const Change& change, double times = 1.0) {
  const auto turn = [times](double t) {
    return Quat(Eigen::AngleAxisd(times * (0.3 + std::sin(2.0 * t)), Vec3::UnitX()) *
                Eigen::AngleAxisd(times * (0.8 * std::cos(3.0 * t) + 0.5), Vec3::UnitY()));
  };
  ImuSamples out;
  for (int k = 0; k < 500; ++k) {
    const double t = step_s * k;
    const Quat q = turn(t), stated = change(q);
    const Quat ahead = turn(t - 1e-4).conjugate() * turn(t + 1e-4);
    const Vec3 rate = ahead.vec() * 2.0 / 2e-4, measured = q.conjugate() * Vec3(0.3, 9.81, 0.0);
    out.stamps.push_back(utc_time(static_cast<std::int64_t>(1e9 * t)));
    out.orientation.insert(out.orientation.end(), {stated.w(), stated.x(), stated.y(), stated.z()});
    out.acceleration.insert(out.acceleration.end(), measured.begin(), measured.end());
    out.angular_velocity.insert(out.angular_velocity.end(), rate.begin(), rate.end());
    out.valid.push_back(1);
  }
  return out;
}

std::string judged_node(const ImuSamples& block, const ImuContent& content) {
  OrientationSense sense;
  sense.add(block);
  FileFindings out{"w.csv"};
  sense.judge({{"wrist"}, content}, out);
  std::string all;
  for (const Finding& finding : out.all) all += to_string(finding.what) + "\n";
  return all;
}

constexpr ImuContent with_gravity{true, true, true, true}, without{true, true, true, false};

bool has(const std::string& text, const char* what) { return text.find(what) != std::string::npos; }

}  // namespace

TEST_CASE("a node whose orientations, accelerations and turns are one is left alone") {
  CHECK(judged_node(swinging(as_it_is), with_gravity).empty());
  CHECK(judged_node(swinging(as_it_is), without).empty());
}

TEST_CASE("parts in another order, the inverse and another axis up show in gravity and in turns") {
  const std::string shifted = judged_node(swinging(parts_shifted), with_gravity);
  CHECK(has(shifted, "w.csv: expected gravity of 'wrist' that points up in the world, found"));
  CHECK(
      has(shifted, "w.csv: expected orientations of 'wrist' that turn as the gyroscope measures"));
  CHECK(has(judged_node(swinging(other_way), with_gravity), "as the gyroscope measures"));
  CHECK(judged_node(swinging(z_up), with_gravity) ==
        "w.csv: expected gravity of 'wrist' that points up in the world, found a mean of 90 "
        "degrees away\n");
  CHECK(judged_node(swinging(z_up), without).empty());  // without gravity any axis may point up
}

TEST_CASE("one sample just before the next, or one wild rate, outweighs no other") {
  for (const std::int64_t ns : {100'000, 1'000, 1}) {
    CAPTURE(ns);
    ImuSamples late = swinging(as_it_is);
    late.stamps[200] = late.stamps[201] - Duration{ns};
    CHECK(judged_node(late, with_gravity).empty());
  }
  ImuSamples wild = swinging(as_it_is);
  wild.angular_velocity[3 * 200] = 2000.0;
  CHECK(judged_node(wild, with_gravity).empty());
}

TEST_CASE("gravity may lean by up to 45 degrees") {
  const auto leaning = [](double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    return judged_node(
        swinging([half](const Quat& q) { return Quat(std::cos(half), std::sin(half), 0, 0) * q; }),
        with_gravity);
  };
  CHECK(leaning(40).empty());
  CHECK(has(leaning(50), "gravity of 'wrist'"));
}

TEST_CASE("a node at rest says nothing of its turns, and a few samples nothing at all") {
  CHECK(!has(judged_node(swinging(parts_shifted, 0.02), with_gravity), "gyroscope"));
  ImuSamples few = swinging(parts_shifted);
  few.stamps.resize(40);
  few.valid.resize(40);
  CHECK(judged_node(few, with_gravity).empty());
}

TEST_CASE("samples that are not valid, and steps of a second, prove nothing") {
  ImuSamples lost = swinging(parts_shifted);
  for (std::size_t k = 0; k < lost.valid.size(); k += 2) lost.valid[k] = 0;
  CHECK(!has(judged_node(lost, with_gravity), "gyroscope"));
  ImuSamples slow = swinging(parts_shifted);
  for (std::size_t k = 0; k < slow.stamps.size(); ++k) {
    slow.stamps[k] = utc_time(static_cast<std::int64_t>(k) * 1'000'000'000);
  }
  CHECK(!has(judged_node(slow, with_gravity), "gyroscope"));
}
