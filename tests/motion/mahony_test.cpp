// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/mahony.h"

#include "tests/about.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace kinalign;

namespace {

constexpr double gravity = 9.80665;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
const Vec3 still = Vec3::Zero();
const Vec3 upright(0.0, gravity, 0.0);

/// The angle between the estimated and the true up in the sensor's axes, rad.
double tilt_error(const Quat& estimate, const Quat& truth) {
  const Vec3 seen = estimate.conjugate() * Vec3::UnitY(), is = truth.conjugate() * Vec3::UnitY();
  return std::atan2(seen.cross(is).norm(), seen.dot(is));
}

Vec3 any_vector(std::mt19937_64& random, double size) {
  std::normal_distribution<double> normal;
  return size * Vec3(normal(random), normal(random), normal(random));
}

}  // namespace

TEST_CASE(
    "the first reading sets the tilt, however the sensor lies, and the heading is the given one") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Quat truth = rotation(any_vector(random, 2.0));
    MahonyFilter filter({.heading = 0.7});
    CHECK_FALSE(filter.has_tilt());
    CHECK(filter.update(0.01, {any_vector(random, 1.0), truth.conjugate() * upright}));
    CHECK(filter.has_tilt());
    CHECK(tilt_error(filter.orientation(), truth) < 1e-12);
    CHECK(heading_of(filter.orientation()) == about(0.7, 1e-9));
  }
  // Upside down no turn is the shortest; it is half a turn about x.
  MahonyFilter filter;
  filter.update(0.01, {still, -upright});
  CHECK(angle_between(filter.orientation(), Quat(0, 1, 0, 0)) < 1e-12);
}

TEST_CASE("a constant rate turns by rate times time, exactly, whatever the steps") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(1e-4, 0.05);
  const Vec3 rate(0.9, -1.7, 0.4);
  MahonyFilter filter({.tilt_gain = 0.0, .bias_gain = 0.0});
  filter.update(0.01, {rate, upright});
  double time = 0.0;
  while (time < 20.0) {
    const double dt = step(random);
    filter.update(dt, {rate, upright});
    time += dt;
  }
  CHECK(angle_between(filter.orientation(), rotation(Vec3(rate * time))) < 1e-10);
}

TEST_CASE("what is known of the bias at the start is taken off") {
  const Vec3 bias(0.02, -0.01, 0.03);
  MahonyFilter filter({.gyroscope_bias = bias});
  for (int i = 0; i < 1000; ++i) filter.update(0.01, {bias, upright});
  CHECK(angle_between(filter.orientation(), Quat::Identity()) < 1e-12);
}

TEST_CASE("a wrong tilt of a sensor at rest falls as the differential equation says") {
  // error' = -kP sin(error): tan(error / 2) falls as exp(-kP t), from any tilt.
  for (const double first : {0.01, 0.5, 2.0, 3.0}) {
    MahonyFilter filter({.tilt_gain = 0.5, .bias_gain = 0.0});
    filter.update(0.001, {still, rotation(Vec3(first, 0, 0)).conjugate() * upright});
    for (int i = 1; i <= 6000; ++i) {
      filter.update(0.001, {still, upright});
      if (i % 1000 != 0) continue;
      const double expected = 2.0 * std::atan(std::tan(first / 2.0) * std::exp(-0.0005 * i));
      // A step of Euler's rule is off by kP dt^2 / 2 of the error: 6000 steps by 1.5e-3 of it.
      CHECK(tilt_error(filter.orientation(), Quat::Identity()) == about(expected, 2e-3));
    }
  }
}

TEST_CASE("a bias is learnt as a critically damped filter learns it, but about the vertical") {
  // e'' = -kP e' - kI e from e = 0, e' = b. So e = b t exp(-t / tau), and the part of the bias that
  // is not learnt yet is b (1 + t / tau) exp(-t / tau), with tau = 2 / kP.
  const Vec3 bias(0.01, 0.02, -0.005);
  MahonyFilter filter({.tilt_gain = 0.4, .bias_gain = 0.04});
  filter.update(0.001, {bias, upright});
  double longest = 0.0;
  for (int i = 1; i <= 60000; ++i) {
    filter.update(0.001, {bias, upright});
    longest = std::max(longest, tilt_error(filter.orientation(), Quat::Identity()));
    if (i % 5000 != 0 || i > 20000) continue;
    const double t = 0.001 * i / 5.0;
    const double left = (1.0 + t) * std::exp(-t);
    // The turn about the vertical mixes x and z, so only their length falls.
    const Vec3 wrong = bias - filter.gyroscope_bias();
    CHECK(std::hypot(wrong.x(), wrong.z()) == about(left * std::hypot(bias.x(), bias.z()), 0.03));
  }
  CHECK(longest == about(std::hypot(0.01, 0.005) * 5.0 / std::numbers::e, 0.03));
  CHECK(std::abs(filter.gyroscope_bias().x() - bias.x()) < 2e-6);
  CHECK(std::abs(filter.gyroscope_bias().z() - bias.z()) < 2e-6);
  CHECK(std::abs(filter.gyroscope_bias().y()) < 1e-3);
  // So the heading drifts by the bias times the time.
  CHECK(heading_of(filter.orientation()) == about(0.02 * 60.0, 0.02));
}

TEST_CASE("sample by sample it is what the paper's matrices give in NumPy") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> step(0.001, 0.05);
    constexpr std::size_t n = 500;
    Arrays given{{"gains", {0.8, 0.1}}, {"heading", {-1.2}}, {"bias", {0.01, -0.02, 0.03}}};
    for (std::size_t i = 0; i < n; ++i) {
      given["dt"].push_back(step(random));
      for (const double x : any_vector(random, 2.0)) given["rates"].push_back(x);
      for (const double x : any_vector(random, 9.0)) given["accelerations"].push_back(x);
    }
    const Arrays found = run_python("mahony.py", given);
    MahonyFilter filter({.tilt_gain = 0.8,
                         .bias_gain = 0.1,
                         .heading = -1.2,
                         .gyroscope_bias = Vec3(0.01, -0.02, 0.03),
                         .least_acceleration = 0.0});
    double worst = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      filter.update(given["dt"][i], {vec3(given["rates"], i), vec3(given["accelerations"], i)});
      const Eigen::Matrix3d ours = filter.orientation().toRotationMatrix();
      for (Eigen::Index k = 0; k < 9; ++k) {
        worst =
            std::max(worst, std::abs(ours(k / 3, k % 3) -
                                     found.at("rotations")[9 * i + static_cast<std::size_t>(k)]));
      }
      const Vec3 wrong = filter.gyroscope_bias() - vec3(found.at("biases"), i);
      worst = std::max(worst, wrong.norm());
    }
    CHECK(worst < 1e-10);
  }
}

TEST_CASE("after a gap the tilt restarts from gravity, heading and bias stay") {
  const Vec3 bias(0.0, 0.02, 0.0);
  MahonyFilter filter({.heading = 0.4, .gyroscope_bias = bias, .longest_step_s = 0.5});
  filter.update(0.01, {bias, upright});
  const Quat after = rotation(Vec3(0.0, 0.0, 0.9));
  CHECK(filter.update(0.6, {Vec3(5.0, 5.0, 5.0), after.conjugate() * upright}));
  CHECK(tilt_error(filter.orientation(), after) < 1e-12);
  CHECK(heading_of(filter.orientation()) == about(0.4));
  CHECK(filter.gyroscope_bias() == bias);
  // Half a second is no gap: the rate turns the sensor through it.
  MahonyFilter turns({.tilt_gain = 0.0, .bias_gain = 0.0});
  turns.update(0.01, {still, upright});
  turns.update(0.5, {Vec3(1.0, 0.0, 0.0), upright});
  CHECK(angle_between(turns.orientation(), rotation(Vec3(0.5, 0, 0))) < 1e-12);
}

TEST_CASE("an uninformative acceleration corrects nothing, and the rate still turns") {
  for (const Vec3& nothing : {Vec3(0, 0, 0), Vec3(0.3, 0.5, 0.2), Vec3(0, no_number, 0),
                              Vec3(0, std::numeric_limits<double>::infinity(), 0)}) {
    MahonyFilter filter({.tilt_gain = 1.0, .bias_gain = 0.3});
    filter.update(0.01, {still, upright});
    for (int i = 0; i < 100; ++i) CHECK(filter.update(0.01, {Vec3(0.5, 0, 0), nothing}));
    CHECK(angle_between(filter.orientation(), rotation(Vec3(0.5, 0, 0))) < 1e-12);
    CHECK(filter.gyroscope_bias() == Vec3::Zero());
    // Such an acceleration does not set the tilt either. The first one with a usable up does,
    // without a turn.
    MahonyFilter blind;
    CHECK(blind.update(0.01, {Vec3(0.5, 0, 0), nothing}));
    CHECK_FALSE(blind.has_tilt());
    CHECK(angle_between(blind.orientation(), Quat::Identity()) == 0.0);
  }
}

TEST_CASE("a rate that is not finite is left out, and the next one makes up for its time") {
  MahonyFilter filter({.tilt_gain = 0.0, .bias_gain = 0.0});
  filter.update(0.01, {still, upright});
  CHECK_FALSE(filter.update(0.1, {Vec3(no_number, 0, 0), upright}));
  CHECK(filter.orientation().coeffs().allFinite());
  CHECK(filter.update(0.1, {Vec3(1.0, 0, 0), upright}));
  CHECK(angle_between(filter.orientation(), rotation(Vec3(0.2, 0, 0))) < 1e-12);
}

TEST_CASE("a step that is no step changes nothing") {
  MahonyFilter filter;
  filter.update(0.01, {still, upright});
  const Quat before = filter.orientation();
  for (const double dt : {0.0, -0.1, no_number}) {
    CHECK_FALSE(filter.update(dt, {Vec3(1, 2, 3), Vec3(1, 2, 3)}));
  }
  CHECK(angle_between(filter.orientation(), before) == 0.0);
  CHECK(filter.update(0.1, {Vec3(0, 1.0, 0), upright}));
  CHECK(heading_of(filter.orientation()) == about(0.1, 1e-9));
}
