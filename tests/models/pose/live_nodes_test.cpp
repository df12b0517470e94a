// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/live_nodes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

const Time begin = utc_time(1'790'000'000'000'000'000);

NodeReadings reading_at(Time stamp) {
  const double t = seconds(stamp - begin);
  return {stamp,
          stamp,
          Quat(Eigen::AngleAxisd(std::sin(t), Vec3::UnitX())),
          Vec3(std::sin(3 * t), 9.8, std::cos(2 * t)),
          Vec3(std::cos(t), 0.1, 0.0),
          true};
}

/// Samples of three nodes at 100 Hz with jitter, a gap in the second.
std::vector<std::pair<std::size_t, NodeReadings>> samples(double seconds_long) {
  std::mt19937_64 random(3);
  std::vector<std::pair<std::size_t, NodeReadings>> out;
  for (int i = 0; i < static_cast<int>(100 * seconds_long); ++i) {
    for (std::size_t n = 0; n < 3; ++n) {
      if (n == 1 && i >= 120 && i < 160) continue;
      const Duration jitter{static_cast<std::int64_t>(random() % 2'000'000)};
      out.emplace_back(n, reading_at(begin + i * 10ms + (n == 2 ? Duration{0} : jitter)));
    }
  }
  return out;
}

}  // namespace

TEST_CASE("frames are those of the whole tracks, also where samples overtake each other") {
  auto all = samples(4.0);
  std::vector<NodeTrack> tracks(3);
  for (const auto& [n, one] : all) {
    NodeTrack& track = tracks[n];
    track.stamps.push_back(one.stamp);
    track.orientation.resize(4 * track.stamps.size());
    put_quat(track.orientation, track.stamps.size() - 1, *one.orientation);
    for (int k = 0; k < 3; ++k) {
      track.acceleration.push_back((*one.acceleration)(k));
      track.angular_velocity.push_back((*one.angular_velocity)(k));
    }
  }
  const auto whole = even_nodes(tracks, 30.0);
  REQUIRE(whole);
  for (std::size_t i = 8; i + 5 < all.size(); i += 9) std::swap(all[i], all[i + 4]);
  LiveNodes live(3, 30.0);
  std::size_t t = 0;
  for (const auto& [n, one] : all) {
    live.add(n, one);
    if (!live.begin()) continue;
    for (; t < whole->worn.frames(); ++t) {
      const Time time = begin + Duration{std::llround(static_cast<double>(t) * 1e9 / 30.0)};
      // If it waits 50 ms longer than a frame needs, no sample that was overtaken is missing.
      if (!live.is_ready(time + 50ms, one.stamp)) break;
      const WornFrames frame = live.frame(time);
      CAPTURE(t);
      for (std::size_t m = 0; m < 3; ++m) {
        CHECK(frame.valid[m] == whole->worn.valid[3 * t + m]);
        if (frame.valid[m] == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t at = 3 * (3 * t + m) + k;
          CHECK(frame.acceleration[3 * m + k] == whole->worn.acceleration[at]);
          CHECK(frame.angular_velocity[3 * m + k] == whole->worn.angular_velocity[at]);
        }
      }
    }
  }
  CHECK(t > 100);
  CHECK(live.late() == 0);
}

TEST_CASE("a frame waits for a node that is behind, not for one that is dead or has never come") {
  LiveNodes live(3, 30.0);
  CHECK(!live.begin());
  live.add(2, reading_at(begin));
  REQUIRE(live.begin() == begin);
  const auto root_until = [&](Duration d) { live.add(2, reading_at(begin + d)); };
  root_until(100ms);
  CHECK(live.is_ready(begin, begin + 100ms));  // no sample of the others has come
  live.add(0, reading_at(begin));
  CHECK(!live.is_ready(begin, begin + 100ms));
  CHECK(live.is_ready(begin, begin + LiveNodes::reach + LiveNodes::patience));
  root_until(3s);
  CHECK(live.is_ready(begin + 2900ms, begin + 3s));   // node 0 has been silent for three seconds
  CHECK(!live.is_ready(begin + 2990ms, begin + 3s));  // samples after it are still to come
}

TEST_CASE("samples that can't be used are left out and counted") {
  LiveNodes live(3, 30.0);
  NodeReadings one = reading_at(begin);
  live.add(0, one);
  live.add(0, one);  // came twice
  one.stamp += 10ms;
  one.acceleration.reset();
  live.add(0, one);
  one = reading_at(begin + 20ms);
  one.orientation.reset();  // the first sample had an orientation
  live.add(0, one);
  CHECK(live.left_out() == 3);
}
