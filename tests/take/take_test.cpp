// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/take.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// One row of a clip of one joint, of one point and of one node without accelerations; all numbers
/// are `value`.
TakeSlab row(double value) {
  const auto whole = static_cast<std::int64_t>(value);
  const auto byte = static_cast<std::uint8_t>(value);
  const SampleDistance distance{{whole}, {whole + 1}};
  TakeSlab out;
  out.first = static_cast<std::uint64_t>(whole);
  out.stamps = {utc_time(whole)};
  out.rows = {ClipRows{{value, value, value},
                       {value, value, value},
                       {value, value, value, value},
                       {byte},
                       distance},
              PointRows{{value, value, value}, {static_cast<Tracking>(byte)}, {byte}, distance},
              ImuRows{{value, value, value, value}, {}, {value, value, value}, {byte}, distance}};
  return out;
}

}  // namespace

TEST_CASE("slabs put behind one another are all their rows, array by array") {
  TakeSlab all;
  append_rows(all, row(0));
  append_rows(all, row(1));
  CHECK(all.first == 0);
  CHECK(all.stamps == std::vector<Time>{utc_time(0), utc_time(1)});
  REQUIRE(all.rows.size() == 3);
  using Numbers = std::vector<double>;
  using Bytes = std::vector<std::uint8_t>;
  const auto& clip = std::get<ClipRows>(all.rows[0]);
  CHECK(clip.positions == Numbers{0, 0, 0, 1, 1, 1});
  CHECK(clip.local_positions == Numbers{0, 0, 0, 1, 1, 1});
  CHECK(clip.local_rotations == Numbers{0, 0, 0, 0, 1, 1, 1, 1});
  CHECK(clip.valid == Bytes{0, 1});
  const auto& points = std::get<PointRows>(all.rows[1]);
  CHECK(points.positions == Numbers{0, 0, 0, 1, 1, 1});
  CHECK(points.state == std::vector<Tracking>{Tracking::missing, Tracking::inferred});
  CHECK(points.valid == Bytes{0, 1});
  const auto& imu = std::get<ImuRows>(all.rows[2]);
  CHECK(imu.orientation == Numbers{0, 0, 0, 0, 1, 1, 1, 1});
  CHECK(imu.acceleration.empty());
  CHECK(imu.angular_velocity == Numbers{0, 0, 0, 1, 1, 1});
  for (const SampleDistance& distance : {clip.distance, points.distance, imu.distance}) {
    CHECK(distance.nearest_raw_ns == std::vector<std::int64_t>{0, 1});
    CHECK(distance.time_interval_ns == std::vector<std::int64_t>{1, 2});
  }
}
