// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/kinect_size.h"

#include <doctest/doctest.h>

#include <limits>

using namespace kinalign;

namespace {

const std::vector<std::string> joints{"SpineBase", "SpineShoulder", "ShoulderLeft", "ElbowLeft",
                                      "HipLeft",   "KneeLeft",      "AnkleLeft"};

/// The mean person of UI-PRMD, enlarged by `factor`, with all joints of the left side on one line.
JointFrames on_a_line(double factor, std::size_t frames) {
  JointFrames out{joints.size(), {}, {}};
  for (std::size_t t = 0; t < frames; ++t) {
    for (const double y :
         {0.0, 0.534, 0.5, 0.5 + 0.256, -0.1, -0.1 - 0.371, -0.1 - 0.371 - 0.382}) {
      for (const double value : {0.3, factor * y, 2.0}) {
        out.positions.push_back(static_cast<float>(value));
      }
      out.seen.push_back(2);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a person's legs are in proportion to all bones that a Kinect shows") {
  for (const double factor : {0.9, 1.0, 1.15}) {
    const auto legs = legs_by_kinect(joints, on_a_line(factor, 40));
    REQUIRE(legs);
    CHECK(*legs == doctest::Approx(0.837 * factor).epsilon(1e-5));
  }
}

TEST_CASE("joints that are inferred, missing or wrong for some frames do not change the size") {
  JointFrames kinect = on_a_line(1.0, 100);
  for (std::size_t t = 0; t < 40; ++t) {
    for (std::size_t j = 0; j < kinect.joints; ++j) {
      const std::size_t at = t * kinect.joints + j;
      if (t % 2 == 0) kinect.seen[at] = static_cast<std::uint8_t>(t % 4 == 0 ? 1 : 0);
      kinect.positions[3 * at + 1] =
          t % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(9 * j);
    }
  }
  const auto legs = legs_by_kinect(joints, kinect);
  REQUIRE(legs);
  CHECK(*legs == doctest::Approx(0.837).epsilon(1e-5));
}

TEST_CASE("a Kinect that hardly saw the person states no size") {
  CHECK_FALSE(legs_by_kinect(joints, on_a_line(1.0, 29)));
  JointFrames trunk = on_a_line(1.0, 60);
  for (std::size_t i = 0; i < trunk.seen.size(); ++i) {
    if (i % trunk.joints > 1) trunk.seen[i] = 1;
  }
  CHECK_FALSE(legs_by_kinect(joints, trunk));
}
