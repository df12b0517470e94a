// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/even_nodes.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

Time at_s(double s) { return utc_time(1'000'000'000 + std::llround(s * 1e9)); }

Vec3 push(double t) { return {std::sin(3.0 * t), 0.4, std::cos(2.0 * t)}; }  // m/s2, in the world

/// A node that turns about a fixed axis and is accelerated, sampled at `rate_hz` for 2 s.
NodeTrack turning_node(double rate_hz, bool gravity = true) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  NodeTrack out;
  out.gravity = gravity;
  for (int i = 0; i <= static_cast<int>(2.0 * rate_hz); ++i) {
    const double t = i / rate_hz;
    const Quat q = rotation(2.0 * t * axis);
    const Vec3 force = q.conjugate() * (push(t) + Vec3(0, gravity ? 9.80665 : 0.0, 0));
    out.stamps.push_back(at_s(t));
    for (const double v : {q.w(), q.x(), q.y(), q.z()}) out.orientation.push_back(v);
    for (const double v : force) out.acceleration.push_back(v);
    for (const double v : axis) out.angular_velocity.push_back(2.0 * v);
  }
  return out;
}

Eigen::Vector3f acceleration_of(const EvenNodes& nodes, std::size_t at) {
  return Eigen::Map<const Eigen::Vector3f>(&nodes.worn.acceleration[3 * at]);
}

}  // namespace

TEST_CASE("nodes of other rates stand on the model's grid, without gravity, in the world") {
  const auto even =
      even_nodes({turning_node(100.0), turning_node(15.0), turning_node(60.0, false)}, 30.0);
  REQUIRE(even);
  CHECK(even->start == at_s(0.0));
  REQUIRE(even->worn.frames() == 61);
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  for (std::size_t t = 3; t < 58; ++t) {
    const double s = static_cast<double>(t) / 30.0;
    for (std::size_t n = 0; n < 3; ++n) {
      CAPTURE(n);
      const std::size_t at = 3 * t + n;
      CHECK(even->worn.valid[at] == 1);
      const float* q = &even->worn.orientation[4 * at];
      CHECK(Quat(q[0], q[1], q[2], q[3]).angularDistance(rotation(2.0 * s * axis)) < 1e-5);
      // The mean over 67 ms is off by (67 ms)^2 / 12 of the second derivative, which is at most 9
      // m/s4.
      CHECK((acceleration_of(*even, at).cast<double>() - push(s)).norm() < 0.006);
      CHECK(even->worn.angular_velocity[3 * at] == doctest::Approx(2.0 * axis.x()));
    }
  }
}

TEST_CASE("an acceleration is the second difference of positions, as models learn it") {
  // x(t) = t^4 / 12 has the acceleration t^2; its second difference over h is t^2 + h^2 / 6.
  NodeTrack track = turning_node(1000.0, false);
  for (std::size_t i = 0; i < track.stamps.size(); ++i) {
    const double t = static_cast<double>(i) / 1000.0;
    put_quat(track.orientation, i, Quat::Identity());
    vec3(track.acceleration, i) = Vec3(t * t, 0.0, 0.0);
  }
  const auto even = even_nodes({track, track, track}, 30.0);
  REQUIRE(even);
  const double h = 4.0 / 60.0;
  CHECK(acceleration_of(*even, 3 * 30).x() == doctest::Approx(1.0 + h * h / 6.0).epsilon(1e-4));
}

TEST_CASE("over a gap of more than 0.2 s a node is not valid, over a shorter one it is") {
  NodeTrack root = turning_node(100.0), leaf = root;
  const auto cut = [](NodeTrack& track, std::size_t from, std::size_t to) {
    const auto erase = [&](auto& values, std::size_t width) {
      const auto begin = values.begin();
      values.erase(begin + static_cast<std::ptrdiff_t>(from * width),
                   begin + static_cast<std::ptrdiff_t>(to * width));
    };
    erase(track.stamps, 1);
    erase(track.orientation, 4);
    erase(track.acceleration, 3);
    erase(track.angular_velocity, 3);
  };
  cut(leaf, 101, 131);  // 1.00 to 1.31 s
  cut(leaf, 51, 65);    // 0.50 to 0.65 s
  const auto even = even_nodes({leaf, NodeTrack{}, root}, 30.0);
  REQUIRE(even);
  for (std::size_t t = 0; t < even->worn.frames(); ++t) {
    CAPTURE(t);
    CHECK(even->worn.valid[3 * t] == (t >= 31 && t <= 39 ? 0 : 1));
    CHECK(even->worn.valid[3 * t + 1] == 0);
    CHECK(even->worn.valid[3 * t + 2] == 1);
  }
  CHECK((acceleration_of(*even, 3 * 17).cast<double>() - push(17.0 / 30.0)).norm() < 0.05);
}

TEST_CASE("a node without orientation gets one, with its own heading") {
  NodeTrack track = turning_node(100.0);
  track.orientation.clear();
  for (std::size_t i = 0; i < track.stamps.size(); ++i) {
    vec3(track.angular_velocity, i).setZero();
    vec3(track.acceleration, i) = Vec3(0.0, 0.0, 9.80665);
  }
  REQUIRE(complete(track));
  CHECK((quat(track.orientation, 100) * Vec3::UnitZ() - Vec3::UnitY()).norm() < 1e-6);
}

TEST_CASE("a node without angular velocity gets it from its orientations") {
  NodeTrack track = turning_node(100.0);
  const std::vector<double> said = track.angular_velocity;
  track.angular_velocity.clear();
  REQUIRE(complete(track));
  REQUIRE(track.angular_velocity.size() == said.size());
  for (std::size_t i = 0; i + 3 < said.size(); ++i) {
    CHECK(track.angular_velocity[i] == doctest::Approx(said[i]));
  }
}

TEST_CASE("nodes of which no orientation can be made are refused") {
  NodeTrack track = turning_node(100.0);
  track.acceleration.clear();
  CHECK(to_string(complete(track).error()) == "expected nodes with acceleration, found none");
  track = turning_node(100.0, false);
  track.orientation.clear();
  CHECK(to_string(complete(track).error()) ==
        "expected nodes with orientation, or with angular velocity and gravity in the "
        "acceleration, found neither");
  CHECK(to_string(even_nodes({turning_node(10.0), NodeTrack{}}, 30.0).error()) ==
        "expected at least two samples of the root's node, found 0");
}
