// SPDX-License-Identifier: Apache-2.0
// Takes of random contents.
#pragma once

#include "kinalign/take/take.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace kinalign {

/// A take of three streams; numbers are floats, so that storing them loses nothing.
inline Take sample_take(std::size_t frames, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  const auto numbers = [&](std::size_t count) {
    std::vector<double> out(count);
    std::uniform_real_distribution<float> range(-2.0F, 2.0F);
    for (double& x : out) x = static_cast<double>(range(random));
    return out;
  };
  const auto flags = [&](std::size_t count) {
    std::vector<std::uint8_t> out(count);
    for (auto& x : out) x = static_cast<std::uint8_t>(random() % 2);
    return out;
  };
  const auto times = [&](std::size_t count) {
    std::vector<std::int64_t> out(count);
    for (auto& x : out) x = static_cast<std::int64_t>(random() % 50'000'000);
    return out;
  };
  Take take;
  take.header.subject = "03";
  take.header.action = "S1A02";
  take.header.frames = frames;
  Skeleton skeleton{{"Hips", "Spine", "H\xc3\xa4nde"},
                    {-1, 0, 1},
                    {{0, 0.95, 0}, {0, 0.1, 0}, {0.2, 0.1, 1.0 / 3}},
                    {{2, {0, 0.1, 0}}}};
  take.header.groups = {
      {"mocap", ClipGroup{skeleton}, false, false, {{"walk.bvh", std::string(64, 'a'), 12345}}},
      {"kinect",
       PointGroup{{"SpineBase", "Head"}},
       true,
       true,
       {{"k.csv", std::string(64, 'b'), 9}}},
      {"imu",
       ImuGroup{{"waist", "wrist_left"}, {true, true, false, true}, "waist"},
       true,
       false,
       {{"w.csv", std::string(64, 'c'), 1}, {"wl.csv", std::string(64, 'd'), 2}}}};
  take.header.parameters.subject = "03";
  StreamOptions stream;
  stream.name = "mocap";
  stream.files = {{"/home/someone/walk.bvh", ""}};
  take.header.parameters.streams = {stream};
  for (std::size_t t = 0; t < frames; ++t) {
    const auto step = static_cast<std::int64_t>(t) * 16'666'667;
    take.all.stamps.push_back(utc_time(1'700'000'000'000'000'000 + step));
  }
  std::vector<Tracking> state;
  for (std::size_t i = 0; i < frames * 2; ++i) state.push_back(static_cast<Tracking>(random() % 3));
  const auto n = frames;
  take.all.rows = {ClipRows{numbers(n * 9), numbers(n * 9), numbers(n * 12), {}, {}},
                   PointRows{numbers(n * 6), state, flags(n * 2), {times(n), times(n)}},
                   ImuRows{numbers(n * 8), numbers(n * 6), {}, flags(n * 2), {times(n * 2), {}}}};
  take.report.frames = frames;
  take.report.reference = "mocap";
  return take;
}

}  // namespace kinalign
