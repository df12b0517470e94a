// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/floor_figures.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace kinalign;

namespace {

SpaceReport space_of(const RigidTransform& transform) {
  SpaceReport space;
  space.method = "fit";
  space.transform = transform;
  return space;
}

/// A Kinect at (1, 0.9, -2) that looks along +x.
PageFloor sideways() {
  const Quat turn(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()));
  const auto floor = floor_of(space_of({turn, Vec3(1.0, 0.9, -2.0)}), 0);
  REQUIRE(floor);
  return *floor;
}

/// The point `ahead` of that Kinect and `aside` of its middle.
Vec3 before_it(double ahead, double aside) { return {1.0 + ahead, 0.3, -2.0 + aside}; }

}  // namespace

TEST_CASE("a Kinect stands where the transform puts its origin, and looks where it turns z") {
  const PageFloor floor = sideways();
  CHECK((floor.camera - Vec3(1.0, 0.9, -2.0)).norm() < 1e-12);
  CHECK((floor.forward - Vec3::UnitX()).norm() < 1e-12);
}

TEST_CASE("a tilted Kinect keeps its direction along the floor") {
  const Quat tilt(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  const auto floor = floor_of(space_of({tilt, Vec3::Zero()}), 0);
  REQUIRE(floor);
  CHECK((floor->forward - Vec3::UnitZ()).norm() < 1e-12);
}

TEST_CASE(
    "a Kinect that looks straight down, or is placed again in every frame, has no known place") {
  const Quat down(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
  CHECK(!floor_of(space_of({down, Vec3::Zero()}), 0));
  SpaceReport paper = space_of({});
  paper.method = "paper";
  CHECK(!floor_of(paper, 0));
}

TEST_CASE("zones end as in the paper, heights do not matter") {
  const PageFloor floor = sideways();
  CHECK(zone_of(floor, before_it(0.49, 0.0)) == Zone::outside);
  CHECK(zone_of(floor, before_it(0.51, 0.0)) == Zone::largest);
  CHECK(zone_of(floor, before_it(0.81, 0.0)) == Zone::best);
  CHECK(zone_of(floor, before_it(3.49, 0.0)) == Zone::best);
  CHECK(zone_of(floor, before_it(3.51, 0.0)) == Zone::largest);
  CHECK(zone_of(floor, before_it(4.51, 0.0)) == Zone::outside);
  const double aside = 2.0 * std::tan(35.0 * std::numbers::pi / 180.0);
  CHECK(zone_of(floor, before_it(2.0, aside - 0.01)) == Zone::best);
  CHECK(zone_of(floor, before_it(2.0, aside + 0.01)) == Zone::outside);
  CHECK(zone_of(floor, before_it(-2.0, 0.0)) == Zone::outside);
}
