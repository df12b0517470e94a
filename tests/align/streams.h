// SPDX-License-Identifier: Apache-2.0
// Small recordings of closed formulas for the tests of alignment.
#pragma once

#include "tests/take/recorded.h"

#include "kinalign/resample/window.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace kinalign::test {

constexpr std::int64_t ms = 1'000'000;

/// A random vector with each part between -most and most.
inline Vec3 any_vector(std::mt19937_64& random, double most) {
  std::uniform_real_distribution<double> range(-most, most);
  return {range(random), range(random), range(random)};
}

/// A motion: where joint j is at time t (s).
using Motion = std::function<Vec3(std::size_t j, double t)>;

inline Vec3 wander(std::size_t j, double t) {
  const double k = static_cast<double>(j) + 1.0;
  return {std::sin(k * t), 1.0 + 0.3 * std::cos(2.0 * t + k),
          0.5 * std::sin(0.7 * t) + 0.1 * k * k};
}

inline std::vector<Time> every(std::int64_t step_ns, std::size_t count, std::int64_t start_ns = 0) {
  std::vector<Time> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(utc_time(start_ns + static_cast<std::int64_t>(i) * step_ns));
  }
  return out;
}

inline PointStream points(const std::vector<std::string>& names, const std::vector<Time>& stamps,
                          const Motion& motion) {
  PointStream out;
  out.joint_names = names;
  out.frames.stamps = stamps;
  for (const Time stamp : stamps) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      const Vec3 p = motion(j, 1e-9 * static_cast<double>(to_ns(stamp)));
      out.frames.positions.insert(out.frames.positions.end(), p.begin(), p.end());
      out.frames.state.push_back(Tracking::tracked);
    }
  }
  return out;
}

inline ImuStream nodes(const std::vector<std::string>& names, const std::vector<Time>& stamps,
                       const std::function<Quat(std::size_t, double)>& turn) {
  ImuStream out;
  out.node_names = names;
  out.content = {true, true, false, true};
  out.samples.stamps = stamps;
  for (const Time stamp : stamps) {
    const double t = 1e-9 * static_cast<double>(to_ns(stamp));
    for (std::size_t s = 0; s < names.size(); ++s) {
      const Quat q = turn(s, t);
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
        out.samples.orientation.push_back(part);
      }
      const Vec3 a = q.conjugate() * Vec3(0.0, 9.81, 0.0);
      out.samples.acceleration.insert(out.samples.acceleration.end(), a.begin(), a.end());
      out.samples.valid.push_back(1);
    }
  }
  return out;
}

/// A manifest in which "kinect" stays in its own space.
inline Manifest own_space() {
  Manifest manifest;
  manifest.spaces["kinect"].method = "none";
  return manifest;
}

/// A stream in blocks of `size` rows, as a reader hands them out.
template <class Frames>
Pass<Frames> in_blocks(const Frames& all, std::size_t size) {
  return [all, size, at = std::size_t{0}](Frames& block) mutable -> Result<bool> {
    block = {};
    if (at == all.size()) return false;
    const std::size_t count = std::min(size, all.size() - at);
    append_rows(block, all, at, count);
    at += count;
    return true;
  };
}

/// A stream that is read in such blocks in every pass; `all` must outlive it.
template <class Frames>
RecordedStream read_in_blocks(RecordedStream stream, const Frames& all, std::size_t size) {
  std::visit(
      [&](auto& input) {
        if constexpr (std::is_same_v<decltype(input.passes), Passes<Frames>>) {
          input.passes = [&all, size]() -> Result<Pass<Frames>> { return in_blocks(all, size); };
        }
      },
      stream.data);
  return stream;
}

}  // namespace kinalign::test
