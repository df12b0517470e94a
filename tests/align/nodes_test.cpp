// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/nodes.h"

#include "tests/align/streams.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

namespace {

const std::vector<std::string> joints{"SpineBase", "Head"};

StreamOptions stream(const std::string& name) {
  StreamOptions out;
  out.name = name;
  return out;
}

Quat turning(std::size_t s, double t) {
  const double k = static_cast<double>(s);
  return Quat(Eigen::AngleAxisd(0.4 * t + k, Vec3::UnitY()) *
              Eigen::AngleAxisd(0.3 * std::sin(t + k), Vec3::UnitX()));
}

/// The gyroscope reading of node `s` at time `t` (s), rad/s.
Vec3 turned_by(std::size_t s, double t) {
  const double k = static_cast<double>(s);
  return {std::sin(t + k), 0.5 + k, std::cos(2.0 * t)};
}

/// Optical points and two nodes that turn; stamps of both are the grid's, so that rows are samples.
Recording worn_nodes() {
  Recording recording;
  recording.streams.push_back(recorded("optical", points(joints, every(10 * ms, 200), wander)));
  ImuStream imu = nodes({"waist", "wrist_left"}, every(10 * ms, 200), turning);
  imu.content.angular_velocity = true;
  for (const Time stamp : imu.samples.stamps) {
    for (const std::size_t s : {std::size_t{0}, std::size_t{1}}) {
      const Vec3 w = turned_by(s, 1e-9 * static_cast<double>(to_ns(stamp)));
      imu.samples.angular_velocity.insert(imu.samples.angular_velocity.end(), w.begin(), w.end());
    }
  }
  recording.streams.push_back(recorded("imu", std::move(imu)));
  return recording;
}

const Quat worn_by_waist(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
const Quat worn_by_wrist(Eigen::AngleAxisd(-2.1, Vec3(3, -1, 0.5).normalized()));

/// The quaternion at another length, which a user may write: the length does not count.
std::vector<double> scaled(const Quat& q) {
  return {1.5 * q.w(), 1.5 * q.x(), 1.5 * q.y(), 1.5 * q.z()};
}

Manifest with_mounting() {
  Manifest manifest;
  manifest.streams = {stream("imu")};
  manifest.streams[0].mounting = {{"waist", scaled(worn_by_waist)},
                                  {"wrist_left", scaled(worn_by_wrist)}};
  return manifest;
}

}  // namespace

TEST_CASE("nodes come into the waist's space and their gravity cancels") {
  const auto turn = [](std::size_t s, double t) {
    return Quat(Eigen::AngleAxisd(0.4 * t, Vec3::UnitY()) *
                Eigen::AngleAxisd(0.3 * static_cast<double>(s) * std::sin(t), Vec3::UnitX()));
  };
  Recording recording;
  recording.streams.push_back(recorded("optical", points(joints, every(10 * ms, 500), wander)));
  const auto jitter = [](std::int64_t start) { return every(66 * ms, 75, start); };
  const auto one = [&](std::size_t s, const std::string& name) {
    return recorded("imu", nodes({name}, jitter(static_cast<std::int64_t>(s) * 7 * ms),
                                 [&, s](std::size_t, double t) { return turn(s, t); }));
  };
  recording.streams.push_back(one(0, "waist"));
  recording.streams.push_back(one(1, "wrist_left"));
  Manifest manifest;
  manifest.streams = {stream("imu")};
  manifest.streams[0].root_node = "waist";
  const auto take = align(recording, manifest);
  REQUIRE(take);
  REQUIRE(take->header.groups.size() == 2);
  const auto& imu = std::get<ImuRows>(take->all.rows[1]);
  for (std::size_t r = 30; r + 30 < take->all.stamps.size(); ++r) {
    const double t = 1e-9 * static_cast<double>(to_ns(take->all.stamps[r]));
    CHECK(imu.valid[2 * r] == 1);
    CHECK(quat(imu.orientation, 2 * r).angularDistance(turn(0, t)) < 1e-5);
    CHECK(quat(imu.orientation, 2 * r + 1).angularDistance(turn(0, t).conjugate() * turn(1, t)) <
          1e-5);
    CHECK((vec3(std::span(imu.acceleration), 2 * r) - Vec3(0, 9.81, 0)).norm() < 1e-9);
    CHECK(vec3(std::span(imu.acceleration), 2 * r + 1).norm() < 1e-9);
  }
}

TEST_CASE("a mounting turns orientations and vectors from the sensor's axes to the bone's") {
  const auto take = align(worn_nodes(), with_mounting());
  REQUIRE(take);
  const auto& imu = std::get<ImuRows>(take->all.rows[1]);
  for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
    const double t = 1e-9 * static_cast<double>(to_ns(take->all.stamps[r]));
    for (const std::size_t s : {std::size_t{0}, std::size_t{1}}) {
      const Quat worn = s == 0 ? worn_by_waist : worn_by_wrist;
      CHECK(quat(imu.orientation, 2 * r + s).angularDistance(turning(s, t) * worn) < 1e-9);
      const Vec3 felt = turning(s, t).conjugate() * Vec3(0, 9.81, 0);
      const Vec3 a = vec3(std::span(imu.acceleration), 2 * r + s);
      CHECK((a - worn.conjugate() * felt).norm() < 1e-9);
      const Vec3 w = vec3(std::span(imu.angular_velocity), 2 * r + s);
      CHECK((w - worn.conjugate() * turned_by(s, t)).norm() < 1e-9);
    }
  }
}

TEST_CASE("with a root node, mountings turn the orientations before, vectors go by the world") {
  Manifest manifest = with_mounting();
  manifest.streams[0].root_node = "waist";
  const auto take = align(worn_nodes(), manifest);
  REQUIRE(take);
  const auto& imu = std::get<ImuRows>(take->all.rows[1]);
  for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
    const double t = 1e-9 * static_cast<double>(to_ns(take->all.stamps[r]));
    const Quat waist = turning(0, t) * worn_by_waist;
    const Quat wrist = turning(1, t) * worn_by_wrist;
    CHECK(quat(imu.orientation, 2 * r).angularDistance(waist) < 1e-9);
    CHECK(quat(imu.orientation, 2 * r + 1).angularDistance(waist.conjugate() * wrist) < 1e-9);
    const Vec3 up = waist.conjugate() * Vec3(0, 9.81, 0);
    CHECK((vec3(std::span(imu.acceleration), 2 * r) - up).norm() < 1e-9);
    CHECK(vec3(std::span(imu.acceleration), 2 * r + 1).norm() < 1e-9);
    for (const std::size_t s : {std::size_t{0}, std::size_t{1}}) {
      const Vec3 world = turning(s, t) * turned_by(s, t);
      const Vec3 w = vec3(std::span(imu.angular_velocity), 2 * r + s);
      CHECK((w - waist.conjugate() * world).norm() < 1e-9);
    }
  }
}

TEST_CASE("a mounting of a node that is not there is refused") {
  Manifest manifest = with_mounting();
  manifest.streams[0].mounting["wrist_right"] = {1, 0, 0, 0};
  const auto take = align(worn_nodes(), manifest);
  REQUIRE(!take);
  CHECK(to_string(take.error()) ==
        "expected a node of 'imu' for mounting (known: waist, wrist_left), found \"wrist_right\"");
}
