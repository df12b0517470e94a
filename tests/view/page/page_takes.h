// SPDX-License-Identifier: Apache-2.0
// A small take whose figures are known in closed form: a mocap of three joints that walks along x,
// a Kinect of three joints that is `offset` away from them.
#pragma once

#include "kinalign/take/take.h"

#include <string>

namespace kinalign {

struct PageTake {
  TakeHeader header;
  TakeSlab slab;
  AlignmentReport report;
};

inline PageTake walking_take(std::size_t frames, const Vec3& offset = {0.03, 0.0, 0.04}) {
  PageTake take;
  const Skeleton skeleton{{"Hips", "LeftForeArm", "LeftHand"},
                          {-1, 0, 1},
                          {{0, 1, 0}, {0.2, 0.4, 0}, {0.25, 0, 0}},
                          {{2, {0.08, 0, 0}}}};
  take.header.frames = frames;
  take.header.groups = {
      {"mocap", ClipGroup{skeleton}, false, false, {{"walk.bvh", std::string(64, 'a'), 12}}},
      {"kinect",
       PointGroup{{"SpineBase", "ElbowLeft", "WristLeft"}},
       true,
       false,
       {{"kinect.csv", std::string(64, 'b'), 34}}}};
  ClipRows clip;
  PointRows points;
  const auto put = [](std::vector<double>& to, const Vec3& p) {
    to.insert(to.end(), {p.x(), p.y(), p.z()});
  };
  for (std::size_t t = 0; t < frames; ++t) {
    take.slab.stamps.push_back(
        utc_time(1'790'000'000'000'000'000 + static_cast<std::int64_t>(t) * 16'666'667));
    const Vec3 root(0.01 * static_cast<double>(t), 1.0, 0.0);
    Vec3 place = root;
    for (std::size_t j = 0; j < 3; ++j) {
      if (j > 0) place += skeleton.rest_offsets[j];
      put(clip.positions, place);
      put(clip.local_positions, j == 0 ? root : skeleton.rest_offsets[j]);
      clip.local_rotations.insert(clip.local_rotations.end(), {1.0, 0.0, 0.0, 0.0});
      put(points.positions, place + offset);
      points.state.push_back(Tracking::tracked);
      points.valid.push_back(1);
    }
    // A raw sample at every second row.
    points.distance.nearest_raw_ns.push_back(t % 2 == 0 ? 0 : 16'666'667);
  }
  take.slab.rows = {std::move(clip), std::move(points)};
  take.report.frames = frames;
  take.report.begin = take.slab.stamps.front();
  take.report.end = take.slab.stamps.back();
  take.report.rate_hz = 60.0;
  take.report.reference = "mocap";
  StreamReport mocap, kinect;
  mocap.stream = "mocap";
  kinect.stream = "kinect";
  kinect.samples = 3 * frames;
  kinect.worst_interval_ns = 0;
  take.report.streams = {mocap, kinect};
  SpaceReport space;
  space.stream = "kinect";
  space.onto = "mocap";
  space.method = "fit";
  space.transform = {Quat::Identity(), Vec3(0.0, 0.9, -2.5)};
  space.after_m = offset.norm();
  space.joints = {{"SpineBase", "Hips", frames, 2.5, offset.norm()},
                  {"WristLeft", "LeftHand", frames, 2.5, offset.norm()}};
  take.report.spaces = {space};
  return take;
}

}  // namespace kinalign
