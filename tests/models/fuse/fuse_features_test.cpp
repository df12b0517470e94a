// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/fuse_features.h"

#include "tests/models/fuse/fuse_people.h"

#include <doctest/doctest.h>

#include <limits>

using namespace kinalign;

namespace {

float worst_difference(const std::vector<float>& a, const std::vector<float>& b) {
  float out = 0.0F;
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

/// Both devices in a world that is turned about the vertical and shifted.
FuseInput turned_world(FuseInput input, double degrees) {
  for (std::size_t n = 0; n < input.nodes.nodes; ++n) turn_heading(input.nodes, n, degrees);
  const Eigen::AngleAxisf yaw(static_cast<float>(degrees * 0.017453292519943295),
                              Eigen::Vector3f::UnitY());
  for (std::size_t at = 0; at < input.kinect.positions.size(); at += 3) {
    Eigen::Map<Eigen::Vector3f> place(&input.kinect.positions[at]);
    place = (yaw * Eigen::Vector3f(place) + Eigen::Vector3f(1.0F, 0.0F, -3.0F)).eval();
  }
  return input;
}

}  // namespace

TEST_CASE("channels do not depend on where a person stands and looks") {
  const FuseLayout layout = fuse_test_layout();
  const FusePerson person = fuse_person(60);
  const auto plain = fuse_features(layout, person.input).input;
  CHECK(plain.size() == 60 * layout.channels());
  CHECK(worst_difference(plain, fuse_features(layout, turned_world(person.input, 77.0)).input) <
        2e-5F);
  FuseInput kinect = person.input;
  lose_all(kinect.nodes.valid);
  CHECK(worst_difference(fuse_features(layout, kinect).input,
                         fuse_features(layout, turned_world(kinect, -130.0)).input) < 2e-5F);
}

TEST_CASE("without its node the space looks where hips and shoulders look") {
  const FuseLayout layout = fuse_test_layout();
  FusePerson person = fuse_person(60);
  // A person whose trunk does not turn against the root.
  lose_all(person.input.nodes.valid);
  const auto features = fuse_features(layout, person.input);
  for (std::size_t t = 0; t < 60; ++t) {
    const Eigen::Vector3f left = features.space[t].turn * Eigen::Vector3f::UnitX();
    const Eigen::Vector3f true_left = person.truth.root[t] * Eigen::Vector3f::UnitX();
    CHECK(left.dot(true_left) > 0.9F);
    CHECK(std::abs(left.y()) < 1e-6F);
  }
}

TEST_CASE("what is missing, or no number, is 0 and its flag is 0") {
  const FuseLayout layout = fuse_test_layout();
  FusePerson person = fuse_person(3);
  person.input.kinect.seen[6] = 0;
  person.input.kinect.positions[3 * 7] = std::numeric_limits<float>::quiet_NaN();
  person.input.kinect.seen[8] = 1;
  const auto input = fuse_features(layout, person.input).input;
  for (const std::size_t j : {6U, 7U}) {
    for (std::size_t k = 0; k < 4; ++k) CHECK(input[4 * j + k] == 0.0F);
  }
  CHECK(input[4 * 8 + 3] == 0.5F);
  CHECK(input[4 * 9 + 3] == 1.0F);
  CHECK(std::all_of(input.begin(), input.end(), [](float v) { return std::isfinite(v); }));
  lose_all(person.input.kinect.seen);
  const auto nothing = fuse_features(layout, person.input).input;
  for (std::size_t c = 0; c < layout.kinect_channels(); ++c) CHECK(nothing[c] == 0.0F);
  CHECK(nothing[layout.channels() - 1] == 1.0F);
  lose_all(person.input.nodes.valid);
  CHECK(fuse_features(layout, person.input).input[layout.channels() - 1] == 0.0F);
}

TEST_CASE("a layout without hips is refused") {
  FuseLayout layout = fuse_test_layout();
  CHECK(validate(layout));
  std::erase(layout.joints, "HipLeft");
  CHECK(to_string(validate(layout).error()) == "expected a joint HipLeft, found none");
}
