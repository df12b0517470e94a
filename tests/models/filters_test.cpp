// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/filters.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace kinalign;

namespace {

constexpr double rate = 30.0;

/// One joint that moves along x by the function `place`, with `noise` m of Gaussian noise on each
/// axis.
template <class Place>
JointFrames one_joint(std::size_t frames, double noise, const Place& place) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, noise);
  JointFrames out{1, {}, std::vector<std::uint8_t>(frames, 2)};
  for (std::size_t t = 0; t < frames; ++t) {
    const double x = place(static_cast<double>(t) / rate);
    for (const double value : {x, 1.0, 2.0}) {
      out.positions.push_back(static_cast<float>(value + (noise > 0.0 ? normal(random) : 0.0)));
    }
  }
  return out;
}

double swing(double s) { return 0.3 * std::sin(2.0 * s); }

template <class Place>
double rms(const JointFrames& body, const Place& place) {
  double sum = 0.0;
  for (std::size_t t = 0; t < body.frames(); ++t) {
    const double error = body.positions[3 * t] - place(static_cast<double>(t) / rate);
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(body.frames()));
}

double still(double) { return 0.5; }

}  // namespace

TEST_CASE("hold: a joint stays where it was tracked last; inferred counts for 0.2 s") {
  JointFrames body = one_joint(20, 0.0, [](double s) { return s; });
  const JointFrames before = body;
  body.seen[4] = 0;
  for (std::size_t t = 8; t < 18; ++t) body.seen[t] = 1;
  hold(body, rate);
  CHECK(body.positions[3 * 4] == before.positions[3 * 3]);
  for (std::size_t t = 8; t < 14; ++t) CHECK(body.positions[3 * t] == before.positions[3 * t]);
  for (std::size_t t = 14; t < 18; ++t) CHECK(body.positions[3 * t] == before.positions[3 * 13]);
  CHECK(body.positions[3 * 18] == before.positions[3 * 18]);
}

TEST_CASE("filters: a joint at rest stays where it is, whatever is missing") {
  for (const int which : {0, 1, 2}) {
    JointFrames body = one_joint(40, 0.0, still);
    for (std::size_t t = 10; t < 20; ++t) body.seen[t] = 0;
    if (which == 0) hold(body, rate);
    if (which == 1) one_euro({}, body, rate);
    if (which == 2) kalman_smooth({}, body, rate);
    for (std::size_t t = 0; t < 40; ++t) CHECK(std::abs(body.positions[3 * t] - 0.5F) < 1e-6F);
  }
}

TEST_CASE("filters: noise gets less, the smoother's most") {
  const JointFrames rough = one_joint(300, 0.01, swing);
  JointFrames euro = rough, kalman = rough;
  kalman_smooth({}, kalman, rate);
  CHECK(rms(kalman, swing) < 0.6 * rms(rough, swing));
  const JointFrames resting = one_joint(300, 0.01, still);
  euro = resting;
  one_euro({}, euro, rate);
  CHECK(rms(euro, still) < 0.6 * rms(resting, still));
}

TEST_CASE("one-euro: no frame knows a later one") {
  JointFrames a = one_joint(60, 0.01, swing), b = a;
  for (std::size_t i = 3 * 30; i < b.positions.size(); ++i) b.positions[i] += 1.0F;
  one_euro({}, a, rate);
  one_euro({}, b, rate);
  for (std::size_t i = 0; i < 3 * 30; ++i) CHECK(a.positions[i] == b.positions[i]);
}

TEST_CASE("kalman: a gap is bridged along the motion, an outlier counts little") {
  JointFrames body = one_joint(90, 0.0, swing);
  for (std::size_t t = 40; t < 46; ++t) body.seen[t] = 0;
  body.positions[3 * 70] += 1.0F;
  kalman_smooth({}, body, rate);
  for (std::size_t t = 40; t < 46; ++t) {
    CHECK(std::abs(body.positions[3 * t] - swing(static_cast<double>(t) / rate)) < 0.01);
  }
  CHECK(std::abs(body.positions[3 * 70] - swing(70.0 / rate)) < 0.1);
}

TEST_CASE("filters: no frames, no answer") {
  for (const int which : {0, 1, 2}) {
    JointFrames body{2, {}, {}};
    if (which == 0) hold(body, rate);
    if (which == 1) one_euro({}, body, rate);
    if (which == 2) kalman_smooth({}, body, rate);
    CHECK(body.positions.empty());
  }
}
