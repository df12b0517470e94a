// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_joints.h"

#include "kinalign/models/joint_names.h"
#include "kinalign/motion/kinect_joints.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

const std::vector<std::string> wanted{"SpineBase", "Head", "HipLeft", "HipRight"};

PointFrames row_at(Time stamp, double t) {
  PointFrames out{{stamp}, {}, {}};
  for (std::size_t j = 0; j < kinect_joints.size(); ++j) {
    const double height = 0.05 * static_cast<double>(j);
    out.positions.insert(out.positions.end(), {std::sin(t), height, 2.0 + 0.1 * std::cos(t)});
    out.state.push_back(Tracking::tracked);
  }
  return out;
}

}  // namespace

TEST_CASE("rows that come one by one lie on the grid as the rows of a file do") {
  std::mt19937_64 random(1);
  PointFrames all;
  std::vector<PointFrames> rows;
  Time stamp = utc_time(1'790'000'000'000'000'000);
  for (int i = 0; i < 100; ++i) {
    stamp += 30ms + Duration{static_cast<std::int64_t>(random() % 7'000'000)};
    if (i % 17 == 5) stamp += 100ms;  // one frame or three were lost
    rows.push_back(row_at(stamp, 0.1 * i));
    all.stamps.push_back(stamp);
    all.positions.insert(all.positions.end(), rows.back().positions.begin(),
                         rows.back().positions.end());
    all.state.insert(all.state.end(), rows.back().state.begin(), rows.back().state.end());
  }
  const auto file = even_frames(wanted, {kinect_joints.begin(), kinect_joints.end()}, all, {});
  REQUIRE(file);
  LiveJoints live(wanted, 30.0);
  std::size_t t = 0;
  const auto compare = [&](Time now) {
    for (; t < file->body.frames(); ++t) {
      const Time time = file->start + Duration{std::llround(static_cast<double>(t) * 1e9 / 30.0)};
      if (!live.is_ready(time, now) || time > now) return;
      CAPTURE(t);
      const JointFrames frame = live.frame(time);
      for (std::size_t i = 0; i < frame.positions.size(); ++i) {
        CHECK(frame.positions[i] ==
              doctest::Approx(file->body.positions[t * frame.positions.size() + i]).epsilon(1e-5));
      }
    }
  };
  for (const PointFrames& row : rows) {
    live.add(row, row.stamps.front());
    if (live.newest() != live.begin()) compare(row.stamps.front());
  }
  CHECK(t > 90);
}

TEST_CASE("a frame waits for the Kinect's next row, but not for one that is silent") {
  LiveJoints live(wanted, 30.0);
  const Time begin = utc_time(1'790'000'000'000'000'000);
  CHECK(live.is_ready(begin, begin));  // no Kinect frame has come
  live.add(row_at(begin, 0.0), begin);
  CHECK(!live.is_ready(begin + 33ms, begin + 40ms));
  CHECK(live.is_ready(begin + 33ms, begin + 33ms + LiveJoints::patience));
  CHECK(live.is_ready(begin + 2s, begin + 2s));
  CHECK(!live.is_ready(begin + 3s, begin + 2s));
}
