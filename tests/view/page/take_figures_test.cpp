// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/take_figures.h"

#include "tests/seeds.h"
#include "tests/view/page/page_takes.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace kinalign;

namespace {

TakePage figures_of(const PageTake& take, TakeFigureOptions options = {}) {
  TakeFigures figures(take.header, take.report, std::move(options));
  figures.add(take.slab);
  return figures.finish();
}

Vec3 at(const std::vector<float>& places, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3f>(&places[3 * i]).cast<double>();
}

PointRows& kinect_of(PageTake& take) { return std::get<PointRows>(take.slab.rows[1]); }

}  // namespace

TEST_CASE("a page keeps the joints of both skeletons, and the counterparts stay the offset apart") {
  const Vec3 offset(0.03, 0.0, 0.04);
  const TakePage page = figures_of(walking_take(100, offset));
  REQUIRE(page.bodies.size() == 2);
  REQUIRE(page.spaces.size() == 1);
  CHECK(page.stride == 1);
  CHECK(page.seconds.size() == 100);
  CHECK(page.bodies[0].joint_names.size() == 4);  // with the end site
  CHECK(page.bodies[0].joint_names[3] == "LeftHand end");
  CHECK((at(page.bodies[0].positions, 3) - Vec3(0.53, 1.4, 0.0)).norm() < 1e-6);
  for (std::size_t t = 0; t < 100; ++t) {
    for (const auto& [ours, theirs] : page.spaces[0].pairs) {
      const Vec3 kinect = at(page.bodies[1].positions, 3 * t + ours);
      const Vec3 mocap = at(page.bodies[0].positions, 4 * t + theirs);
      CHECK((kinect - mocap - offset).norm() < 1e-6);
    }
  }
}

TEST_CASE("bones of a Kinect have their mean, deviation and extremes, of tracked ends only") {
  PageTake take = walking_take(4);
  PointRows& kinect = kinect_of(take);
  // The wrist hangs on the elbow, 25 cm along x: 23, 25, 27 cm, and one that is inferred.
  kinect.positions[9 * 0 + 6] -= 0.02;
  kinect.positions[9 * 2 + 6] += 0.02;
  kinect.positions[9 * 3 + 6] += 1.0;
  kinect.state[3 * 3 + 2] = Tracking::inferred;
  const TakePage page = figures_of(take);
  REQUIRE(page.bones.size() == 1);  // the elbow's parent, the shoulder, is not in the stream
  const BoneLength& bone = page.bones[0];
  CHECK(bone.rows == 3);
  CHECK(bone.mean_m == doctest::Approx(0.25).epsilon(1e-9));
  CHECK(bone.deviation_m == doctest::Approx(0.02).epsilon(1e-9));
  CHECK(bone.shortest_m == doctest::Approx(0.23).epsilon(1e-9));
  CHECK(bone.longest_m == doctest::Approx(0.27).epsilon(1e-9));
}

TEST_CASE("states are counted joint by joint: a valid joint of state 0 was not measured") {
  PageTake take = walking_take(10);
  PointRows& kinect = kinect_of(take);
  kinect.valid[0] = 0;
  kinect.state[0] = Tracking::missing;
  kinect.state[3] = Tracking::missing;  // row 1, which lies between a missing and a tracked sample
  kinect.state[6] = Tracking::inferred;
  const TakePage page = figures_of(take);
  REQUIRE(page.joint_states.size() == 2);
  CHECK(page.joint_states[1].counts[0] == std::array<std::uint64_t, 3>{1, 2, 7});
  CHECK(page.joint_states[1].counts[1] == std::array<std::uint64_t, 3>{0, 0, 10});
  CHECK(page.joint_states[0].counts[0] == std::array<std::uint64_t, 3>{0, 0, 10});
  REQUIRE(page.floors.size() == 1);
  CHECK(page.floors[0].missing == 1);
}

TEST_CASE("lanes hold the share of each bin that was measured, and the largest distances") {
  PageTake take = walking_take(40);
  PointRows& kinect = kinect_of(take);
  for (std::size_t t = 0; t < 10; ++t) kinect.valid[3 * t] = 0;  // a third of the first quarter
  kinect.distance.nearest_raw_ns[25] = 70'000'000;
  TakeFigureOptions options;
  options.bins = 4;
  const TakePage page = figures_of(take, options);
  REQUIRE(page.lanes.size() == 2);
  const PageLane& lane = page.lanes[1];
  CHECK(lane.tracked[0] == doctest::Approx(2.0 / 3.0));
  CHECK(lane.tracked[1] == doctest::Approx(1.0));
  CHECK(lane.nearest_raw_s[2] == doctest::Approx(0.07));
  CHECK(lane.nearest_raw_s[3] == doctest::Approx(0.016666667));
}

TEST_CASE("a take with fewer rows than bins has no empty bins, even where stamps jitter") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<std::int64_t> jitter(-7'000'000, 7'000'000);  // a step is 16.7 ms
    PageTake take = walking_take(2 + random() % 600);
    for (Time& stamp : take.slab.stamps) stamp += Duration{jitter(random)};
    take.report.begin = take.slab.stamps.front();
    take.report.end = take.slab.stamps.back();
    const TakePage page = figures_of(take);
    for (const PageLane& lane : page.lanes) {
      CHECK(lane.tracked.size() <= take.header.frames);
      for (const float share : lane.tracked) CHECK(share == 1.0f);
    }
  }
  CHECK(figures_of(walking_take(100)).lanes[0].tracked == std::vector<float>(50, 1.0f));
  CHECK(figures_of(walking_take(1)).lanes[0].tracked == std::vector<float>{1.0f});
}

TEST_CASE("a long take keeps every stride-th row, in order, and says which") {
  const PageTake take = walking_take(1000);
  TakeFigureOptions options;
  options.most_numbers = 21 * 200;  // numbers of a row: 9 of the mocap, 12 of the Kinect, and one
  const TakePage page = figures_of(take, options);
  CHECK(page.stride == 6);
  CHECK(page.seconds.size() == 167);
  CHECK(page.seconds[1] == doctest::Approx(6 * 0.016666667));
  CHECK(page.bodies[1].positions.size() == 167 * 9);
  REQUIRE(page.details.size() == 1);
  CHECK(page.details[0].seconds.size() == 1000);  // all of the 17 s
  CHECK(page.details[0].onto_positions.size() == 1000 * 2 * 3);
}

TEST_CASE("slabs of any size give the same page") {
  const PageTake take = walking_take(50);
  const TakePage whole = figures_of(take);
  TakeFigures figures(take.header, take.report, {});
  for (std::size_t t = 0; t < 50; ++t) {
    PageTake one = walking_take(50);
    TakeSlab slab;
    slab.first = t;
    slab.stamps = {take.slab.stamps[t]};
    const auto cut = [t](auto& values, std::size_t width) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(t * width);
      values = {from, from + static_cast<std::ptrdiff_t>(width)};
    };
    auto clip = std::get<ClipRows>(one.slab.rows[0]);
    auto kinect = kinect_of(one);
    cut(clip.positions, 9), cut(clip.local_positions, 9), cut(clip.local_rotations, 12);
    cut(kinect.positions, 9), cut(kinect.state, 3), cut(kinect.valid, 3);
    cut(kinect.distance.nearest_raw_ns, 1);
    slab.rows = {clip, kinect};
    figures.add(slab);
  }
  const TakePage again = figures.finish();
  CHECK(again.bodies[0].positions == whole.bodies[0].positions);
  CHECK(again.bodies[1].state == whole.bodies[1].state);
  CHECK(again.lanes[1].tracked == whole.lanes[1].tracked);
  CHECK(again.details[0].near_seconds == whole.details[0].near_seconds);
}

TEST_CASE("without inputs the rows nearest to raw samples stand for them") {
  const TakePage page = figures_of(walking_take(20));
  REQUIRE(page.details.size() == 1);
  CHECK(!page.details[0].has_raw);
  CHECK(page.details[0].near_seconds.size() == 10);
  CHECK(page.details[0].near_s == 0.0F);
}

TEST_CASE("raw samples are moved as alignment moved the stream") {
  const PageTake take = walking_take(20);
  TakeFigureOptions options;
  RawPoints raw{"kinect", {}};
  raw.frames.stamps = {take.slab.stamps[0] + Duration{5'000'000},
                       take.slab.stamps[0] - Duration{1}};
  raw.frames.positions = std::vector<double>(18, 0.5);
  raw.frames.state = {Tracking::tracked, Tracking::inferred, Tracking::missing,
                      Tracking::tracked, Tracking::tracked,  Tracking::tracked};
  options.raw = {raw};
  const TakePage page = figures_of(take, options);
  const PageDetail& detail = page.details[0];
  CHECK(detail.has_raw);
  REQUIRE(detail.raw_seconds.size() == 1);  // the other gap was before the take
  CHECK(detail.raw_seconds[0] == doctest::Approx(0.005));
  CHECK((at(detail.raw_positions, 0) - Vec3(0.5, 1.4, -2.0)).norm() < 1e-6);
  CHECK(at(detail.raw_positions, 2).norm() == 0.0);
  CHECK(detail.raw_state == std::vector<std::uint8_t>{2, 1, 0});
}

TEST_CASE("by the paper each raw sample's root lands on the other root of that time") {
  PageTake take = walking_take(20);
  take.report.spaces[0].method = "paper";
  take.report.spaces[0].transform = {Quat(0.0, 0.0, 1.0, 0.0),
                                     Vec3::Zero()};  // half a turn about y
  TakeFigureOptions options;
  RawPoints raw{"kinect", {}};
  raw.frames.stamps = {take.slab.stamps[3] + Duration{8'333'333}};  // half way to the next row
  raw.frames.positions = {0.0, 0.0, 2.0, 0.1, 0.2, 2.0, 0.0, 0.0, 2.3};
  raw.frames.state = std::vector<Tracking>(3, Tracking::tracked);
  options.raw = {raw};
  const TakePage page = figures_of(take, options);
  const PageDetail& detail = page.details[0];
  REQUIRE(detail.raw_seconds.size() == 1);
  CHECK((at(detail.raw_positions, 0) - Vec3(0.035, 1.0, 0.0)).norm() < 1e-6);
  CHECK((at(detail.raw_positions, 1) - Vec3(-0.065, 1.2, 0.0)).norm() < 1e-6);
  CHECK((at(detail.raw_positions, 2) - Vec3(0.035, 1.0, -0.3)).norm() < 1e-6);
  CHECK(page.floors.empty());
}

TEST_CASE("the longest gap is found across slabs") {
  PageTake take = walking_take(60);
  PointRows& kinect = kinect_of(take);
  for (const std::size_t t : {5, 6, 20, 21, 22, 23, 24}) {
    for (std::size_t j = 0; j < 3; ++j) kinect.valid[3 * t + j] = 0;
  }
  kinect.valid[3 * 40] = 0;  // one lost joint is no gap
  LongestGap gap;
  gap.add(take.slab);
  REQUIRE(gap.middle_s());
  CHECK(*gap.middle_s() == doctest::Approx(22.0 / 60.0).epsilon(1e-6));
  LongestGap none;
  none.add(walking_take(60).slab);
  CHECK(!none.middle_s());
}
