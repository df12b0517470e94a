// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/inertial_truth.h"

#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/rotation.h"
#include "kinalign/simulate/nodes/inertial_sensor.h"

#include <doctest/doctest.h>

#include <functional>

using namespace kinalign;

namespace {

InertialReading reading(const std::function<SensorPlace(double)>& at, double t) {
  std::array<SensorPlace, 5> places;
  for (std::size_t k = 0; k < 5; ++k) places[k] = at(t + 1e-3 * (static_cast<double>(k) - 2.0));
  return true_reading(places, 1e-3);
}

}  // namespace

TEST_CASE("a sensor at rest reads no rate, and gravity upwards, however it lies") {
  for (const Vec3& r : awkward_vectors()) {
    const SensorPlace still{Vec3(1, 2, 3), rotation(r)};
    const InertialReading read = reading([&](double) { return still; }, 0.0);
    CHECK(read.angular_velocity.norm() < 1e-12);
    // The limit is the rounding of 3 m, 2e-16 of it, over 1e-6 s2, times thirty over twelve.
    CHECK((read.acceleration - rotation(r).conjugate() * Vec3(0, 9.80665, 0)).norm() < 1e-8);
  }
}

TEST_CASE("on an arm that turns about the vertical a sensor reads r w^2 inwards, gravity, and w") {
  const double w = 7.0, r = 0.3;
  const auto on_arm = [&](double t) {
    const Quat turned = rotation(Vec3(0, w * t, 0));
    return SensorPlace{turned * Vec3(r, 0, 0), turned};
  };
  for (double t = 0.0; t < 1.0; t += 0.1) {
    const InertialReading read = reading(on_arm, t);
    CHECK((read.acceleration - Vec3(-r * w * w, 9.80665, 0)).norm() < 1e-6);
    CHECK((read.angular_velocity - Vec3(0, w, 0)).norm() < 1e-9);
  }
}

TEST_CASE("on an arm that turns about a level axis, gravity goes round in the sensor") {
  const double w = 5.0, r = 0.4;
  const auto on_arm = [&](double t) {
    const Quat turned = rotation(Vec3(w * t, 0, 0));
    return SensorPlace{turned * Vec3(0, r, 0), turned};
  };
  for (double t = 0.0; t < 1.0; t += 0.1) {
    const Vec3 gravity(0, 9.80665 * std::cos(w * t), -9.80665 * std::sin(w * t));
    CHECK((reading(on_arm, t).acceleration - gravity - Vec3(0, -r * w * w, 0)).norm() < 1e-6);
  }
}

TEST_CASE("a swing gives the derivatives of its formula") {
  // Angle a sin(v t) about z on an arm l along -y: rate a v cos, along the arm l rate^2, across it
  // l times the rate's derivative.
  const double a = 0.8, v = 9.0, l = 0.6;
  const auto swing = [&](double t) {
    const Quat turned = rotation(Vec3(0, 0, a * std::sin(v * t)));
    return SensorPlace{turned * Vec3(0, -l, 0), turned};
  };
  for (double t = 0.0; t < 2.0; t += 0.07) {
    const double angle = a * std::sin(v * t), rate = a * v * std::cos(v * t);
    const InertialReading read = reading(swing, t);
    CHECK(std::abs(read.angular_velocity.z() - rate) < 1e-7);
    const Vec3 gravity(9.80665 * std::sin(angle), 9.80665 * std::cos(angle), 0);
    const Vec3 moved(-l * a * v * v * std::sin(v * t), l * rate * rate, 0);
    CHECK((read.acceleration - gravity - moved).norm() < 1e-5);
  }
}

TEST_CASE("a sensor sits at its offset on the bone and turns with it") {
  GlobalPose pose;
  pose.positions = {Vec3::Zero(), Vec3(1, 1, 0)};
  pose.rotations = {Quat::Identity(), rotation(Vec3(0, 0, std::numbers::pi / 2))};
  const Quat mounted = rotation(Vec3(0.3, 0, 0));
  const SensorPlace place = place_of({"n", 1, Vec3(0.1, 0, 0), mounted}, pose);
  CHECK((place.position - Vec3(1, 1.1, 0)).norm() < 1e-15);
  CHECK(angle_between(place.world_from_sensor, pose.rotations[1] * mounted) < 1e-15);
}
