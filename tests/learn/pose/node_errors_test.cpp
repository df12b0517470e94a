// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/node_errors.h"

#include "tests/models/pose/pose_people.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace kinalign;

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

NodeFrames still(std::size_t nodes) {
  NodeFrames out;
  out.nodes = nodes;
  for (std::size_t n = 0; n < nodes; ++n) {
    append_sample(out, Eigen::Quaternionf::Identity(), Eigen::Vector3f::Zero(),
                  Eigen::Vector3f::Zero());
  }
  return out;
}

/// Root mean square of the turn of node 0 over many draws, degrees.
double rms_turn(const NodeErrors& errors) {
  double sum = 0.0;
  constexpr std::uint64_t draws = 4000;
  for (std::uint64_t i = 0; i < draws; ++i) {
    const NodeFrames nodes = with_errors(still(3), errors, RandomStream(1, i));
    const double w = std::min(1.0, std::abs(static_cast<double>(nodes.orientation[0])));
    sum += std::pow(2.0 * std::acos(w) * degrees, 2);
  }
  return std::sqrt(sum / static_cast<double>(draws));
}

}  // namespace

TEST_CASE("without errors the nodes stay as they are") {
  std::mt19937_64 random(1);
  const NodeFrames nodes = random_nodes(5, 4, random);
  const NodeFrames same = with_errors(nodes, no_node_errors(), RandomStream(1, 1));
  CHECK(same.orientation == nodes.orientation);
  CHECK(same.acceleration == nodes.acceleration);
  CHECK(same.angular_velocity == nodes.angular_velocity);
  CHECK(same.valid == nodes.valid);
}

TEST_CASE("the same stream gives the same errors, another one others") {
  std::mt19937_64 random(2);
  const NodeFrames nodes = random_nodes(5, 4, random);
  const auto first = with_errors(nodes, {}, RandomStream(1, 1));
  CHECK(with_errors(nodes, {}, RandomStream(1, 1)).acceleration == first.acceleration);
  CHECK(with_errors(nodes, {}, RandomStream(1, 2)).acceleration != first.acceleration);
}

TEST_CASE("errors are as large as stated") {
  // Over 4,000 draws a root mean square is accurate to about 1.5 %.
  NodeErrors one = no_node_errors();
  one.mount_deg = 5.0;
  CHECK(rms_turn(one) == doctest::Approx(5.0 * std::sqrt(3.0)).epsilon(0.05));
  one = no_node_errors();
  one.tilt_deg = 1.5;
  CHECK(rms_turn(one) == doctest::Approx(1.5 * std::sqrt(2.0)).epsilon(0.05));
  one = no_node_errors();
  one.yaw_deg = 10.0;
  CHECK(rms_turn(one) == doctest::Approx(10.0 / std::sqrt(3.0)).epsilon(0.05));
  one = no_node_errors();
  one.drift_deg = drift_after(20.0);
  CHECK(drift_after(20.0) == doctest::Approx(13.416).epsilon(1e-4));
  CHECK(rms_turn(one) == doctest::Approx(13.416).epsilon(0.05));
}

TEST_CASE("a tilt leaks half of its share of gravity into the acceleration") {
  NodeErrors tilted = no_node_errors();
  tilted.tilt_deg = 1.5;
  tilted.gravity_leak = 0.5;
  const NodeFrames nodes = with_errors(still(3), tilted, RandomStream(7, 7));
  const Eigen::Quaternionf q(nodes.orientation[0], nodes.orientation[1], nodes.orientation[2],
                             nodes.orientation[3]);
  const Eigen::Vector3f down(0.0F, -9.81F, 0.0F);
  const Eigen::Vector3f expected = 0.5F * (q * down - down);
  const Eigen::Map<const Eigen::Vector3f> leak(nodes.acceleration.data());
  CHECK(expected.norm() > 0.01F);
  CHECK((leak - expected).norm() < 1e-5F);
}

TEST_CASE("leaves are lost as often as asked, the root never") {
  int lost = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const NodeFrames nodes = with_errors(still(5), {}, RandomStream(3, i));
    for (std::size_t n = 0; n < 4; ++n) lost += nodes.valid[n] == 0 ? 1 : 0;
    CHECK(nodes.valid[4] == 1);
  }
  CHECK(lost / 8000.0 == doctest::Approx(0.1).epsilon(0.15));
}
