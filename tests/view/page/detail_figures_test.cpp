// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/detail_figures.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace kinalign;

namespace {

RawNode node_of(std::size_t samples) {
  RawNode node{"imu", "waist", {}, {}, {}};
  for (std::size_t t = 0; t < samples; ++t) {
    node.stamps.push_back(utc_time(1'000'000'000 + static_cast<std::int64_t>(t) * 100'000'000));
    node.angular_velocity.insert(node.angular_velocity.end(), {static_cast<double>(t), 0.0, 0.0});
  }
  return node;
}

}  // namespace

TEST_CASE("a node's raw samples of a stretch are turned as the node is worn") {
  const Quat quarter(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()));
  NodeFigures figures;
  add_raw(node_of(10), quarter, utc_time(1'000'000'000), {0.25, 0.45}, figures);
  CHECK(figures.raw_seconds == std::vector<float>{0.3f, 0.4f});
  REQUIRE(figures.raw_rate.size() == 6);
  CHECK(figures.raw_rate[1] == doctest::Approx(-3.0));  // x of the sensor is -y of the bone
  CHECK(figures.raw_rate[4] == doctest::Approx(-4.0));
  CHECK(figures.raw_acceleration.empty());
}

TEST_CASE("more raw samples than a page shall have are kept around the middle of the stretch") {
  const std::vector<RawNode> raw{node_of(60), node_of(40)};
  const DetailStretch all = raw_node_stretch(raw, {10.0, 30.0}, 100);
  CHECK(all.begin_s == 10.0);
  CHECK(all.end_s == 30.0);
  const DetailStretch half = raw_node_stretch(raw, {10.0, 30.0}, 50);
  CHECK(half.begin_s == doctest::Approx(15.0));
  CHECK(half.end_s == doctest::Approx(25.0));
}
