// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/contents.h"

#include "kinalign/motion/arrays.h"

#include <doctest/doctest.h>

#include <functional>
#include <limits>

using namespace kinalign;

namespace {

constexpr std::size_t rows = 200;

/// A skeleton of two joints, a Kinect of one and a node, at 100 Hz, without a fault.
struct Good {
  Good() {
    header.frames = rows;
    Skeleton skeleton{{"Hips", "Spine"}, {-1, 0}, {Vec3::Zero(), {0, 0.1, 0}}, {}};
    header.groups = {{"mocap", ClipGroup{skeleton}, false, false, {}},
                     {"kinect", PointGroup{{"Head"}}, true, false, {}},
                     {"imu", ImuGroup{{"waist"}, {true, true, true, true}, ""}, true, false, {}}};
    for (std::size_t i = 0; i < rows; ++i) {
      slab.stamps.push_back(utc_time(10'000'000 * static_cast<std::int64_t>(i)));
      const double x = 0.01 * static_cast<double>(i);
      const auto add = [](std::vector<double>& to, std::initializer_list<double> values) {
        to.insert(to.end(), values);
      };
      add(clip.positions, {x, 1, 0, x, 1.1, 0});
      add(clip.local_positions, {x, 1, 0, 0, 0.1, 0});
      add(clip.local_rotations, {1, 0, 0, 0, 1, 0, 0, 0});
      add(points.positions, {x, 1.6, 0});
      points.state.push_back(Tracking::tracked);
      points.valid.push_back(1);
      add(nodes.orientation, {1, 0, 0, 0});
      add(nodes.acceleration, {0, 9.8, 0});
      add(nodes.angular_velocity, {0, 0, 1});
      nodes.valid.push_back(1);
    }
  }

  Findings findings() {
    slab.rows = {clip, points, nodes};
    ContentCheck check(header, 100.0);
    check.add(slab);
    return check.findings("t.h5");
  }

  TakeHeader header;
  TakeSlab slab;
  ClipRows clip;
  PointRows points;
  ImuRows nodes;
};

}  // namespace

TEST_CASE("rows without a fault have no finding") { CHECK(Good().findings().empty()); }

TEST_CASE("each fault of rows is one finding, with its severity") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Fault {
    const char* name;
    Severity severity;
    std::function<void(Good&)> make;
  };
  const std::vector<Fault> faults{
      {"a stamp that steps back", Severity::error,
       [](Good& g) { g.slab.stamps[9] = g.slab.stamps[7]; }},
      {"a rate that is another", Severity::warning,
       [](Good& g) {
         for (std::size_t i = 0; i < rows; ++i)
           g.slab.stamps[i] = utc_time(20'000'000 * static_cast<std::int64_t>(i));
       }},
      {"no number", Severity::error, [nan](Good& g) { g.clip.positions[7] = nan; }},
      {"no number of a valid point", Severity::error,
       [nan](Good& g) { g.points.positions[7] = nan; }},
      {"no number of a valid node", Severity::error,
       [nan](Good& g) { g.nodes.acceleration[7] = nan; }},
      {"a rotation of another length", Severity::error,
       [](Good& g) { g.clip.local_rotations[8] = 0.5; }},
      {"an orientation of another length", Severity::error,
       [](Good& g) { g.nodes.orientation[8] = 0.5; }},
      {"a bone that stretches", Severity::warning,
       [](Good& g) { g.clip.local_positions[4] = 0.2; }},
      {"joints that come apart", Severity::warning, [](Good& g) { g.clip.positions[4] = 1.9; }},
      {"a point at 200 m", Severity::warning, [](Good& g) { g.points.positions[3] = 200; }},
      {"an acceleration of 5000 m/s2", Severity::warning,
       [](Good& g) { g.nodes.acceleration[4] = 5000; }},
      {"a turn of 200 rad/s", Severity::warning,
       [](Good& g) { g.nodes.angular_velocity[4] = 200; }}};
  for (const Fault& fault : faults) {
    CAPTURE(fault.name);
    Good take;
    fault.make(take);
    const Findings found = take.findings();
    REQUIRE_FALSE(found.empty());
    CHECK(found.front().severity == fault.severity);
    CHECK(found.front().what.file == "t.h5");
  }
}

TEST_CASE("cells that are not valid may hold anything") {
  Good take;
  take.points.valid[3] = 0;
  take.points.positions[9] = 1e9;
  take.nodes.valid[3] = 0;
  take.nodes.acceleration[9] = 1e9;
  CHECK(take.findings().empty());
}
