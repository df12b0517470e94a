// SPDX-License-Identifier: Apache-2.0
#include "tests/about.h"
#include "tests/folder.h"
#include "tools/demo/devices.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace kinalign;

namespace {

void write(const FreshFolder& folder, std::uint64_t seed) {
  PosixFiles files;
  const DemoTake take{files, folder.path() + "/", 6.0, seed, "S01", "wave"};
  const DemoMotion motion(demo_body(1.0), seed);
  REQUIRE(write_demo_mocap(take, motion));
  REQUIRE(write_demo_kinect(take, motion));
  REQUIRE(write_demo_imus(take, motion));
  REQUIRE(write_demo_manifest(take));
}

}  // namespace

TEST_CASE("the demo's body has the 59 joints and 13 end sites of the suit, parents first") {
  const DemoBody body = demo_body(1.0);
  REQUIRE(body.joints.size() == demo_joints);
  int ends = 0;
  for (std::size_t j = 0; j < demo_joints; ++j) {
    CHECK(body.joints[j].parent < static_cast<int>(j));
    ends += body.joints[j].end.isZero() ? 0 : 1;
  }
  CHECK(ends == 13);
  CHECK(body.joints[20].name == "RightInHandIndex");
  CHECK(body.joints[36].name == "LeftShoulder");
  CHECK(body.joints[58].name == "LeftHandPinky3");
}

TEST_CASE("the demo stands in T-pose at first, with its feet on the floor") {
  const DemoMotion motion(demo_body(1.0), 7);
  const DemoPlaces places = motion.places(1.0);
  const DemoBody& body = motion.body();
  const Vec3 hand = places.positions[body.find("LeftHand")];
  const Vec3 arm = places.positions[body.find("LeftArm")];
  const Vec3 left(std::cos(demo_heading_deg * std::numbers::pi / 180), 0,
                  -std::sin(demo_heading_deg * std::numbers::pi / 180));
  CHECK((hand - arm).normalized().dot(left) == doctest::Approx(1.0).epsilon(0.01));
  CHECK(places.positions[body.find("LeftFoot")].y() == about(0.077, 0.1));
}

TEST_CASE("the demo's motion has no jump in position, speed or acceleration") {
  const DemoMotion motion(demo_body(1.0), 7);
  constexpr double h = 1e-3;
  Vec3 last = Vec3::Zero();
  for (double t = 0.5; t < 25; t += h) {
    const auto hand = [&](double at) {
      return motion.places(at).positions[motion.body().find("RightHand")];
    };
    const Vec3 acceleration = (hand(t - h) - 2 * hand(t) + hand(t + h)) / (h * h);
    if (t > 0.5) CHECK((acceleration - last).norm() < 1.5);  // m/s2 within a millisecond
    last = acceleration;
  }
}

TEST_CASE("the same seed gives the same bytes, another one others") {
  const FreshFolder a;
  const FreshFolder b;
  const FreshFolder c;
  write(a, 3);
  write(b, 3);
  write(c, 4);
  for (const char* name : {"mocap.bvh", "kinect.csv", "imu_waist.csv", "recording.toml"}) {
    CAPTURE(name);
    CHECK((a.read(name) == b.read(name)));
    CHECK((a.read(name) != c.read(name)));
  }
}

TEST_CASE("an inertial node at rest reads gravity upwards and no turning") {
  const FreshFolder folder;
  write(folder, 3);
  const std::string text = folder.read("imu_waist.csv");
  std::size_t at = text.find('\n') + 1;  // the first sample: still in T-pose
  std::vector<double> row;
  for (const std::size_t end = text.find('\n', at); at < end;) {
    row.push_back(std::strtod(&text[at], nullptr));
    at = std::min(text.find(',', at), end) + 1;
  }
  REQUIRE(row.size() == 11);
  CHECK(std::hypot(row[1], row[2], row[3]) == doctest::Approx(1.0).epsilon(0.01));
  CHECK(std::hypot(row[5], row[6], row[7]) == doctest::Approx(9.8).epsilon(0.03));
  CHECK(std::hypot(row[8], row[9], row[10]) < 0.2);
}

TEST_CASE("the demo's camera sees a face: the left shoulder is at smaller x, as the SDK has it") {
  const FreshFolder folder;
  write(folder, 3);
  const std::string text = folder.read("kinect.csv");
  const std::size_t row = text.find('\n') + 1;
  std::vector<double> cells;
  for (std::size_t at = row; cells.size() < 101; at = text.find(',', at) + 1) {
    cells.push_back(std::strtod(&text[at], nullptr));
  }
  CHECK(cells[1 + 4 * 4] < cells[1 + 4 * 8] - 0.2);  // ShoulderLeft, ShoulderRight: m
  CHECK(cells[1 + 4 * 2 + 2] > 2.0);                 // the neck, in front of the sensor
}
