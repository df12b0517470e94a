// SPDX-License-Identifier: Apache-2.0
// Random points for tests of writers: within nine metres, a fifth of them missing.
#pragma once

#include "tests/folder.h"

#include "kinalign/motion/streams.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace kinalign {

/// Names M0, M1, ...; the stamp of frame t is start_ns + t / rate_hz, rounded.
inline PointStream any_points(std::size_t points, std::size_t frames, double rate_hz,
                              std::int64_t start_ns, std::mt19937_64& random) {
  PointStream out;
  for (std::size_t j = 0; j < points; ++j) out.joint_names.push_back("M" + std::to_string(j));
  std::uniform_real_distribution<double> place(-9.0, 9.0);
  for (std::size_t t = 0; t < frames; ++t) {
    out.frames.stamps.push_back(
        utc_time(start_ns + std::llround(1e9 * static_cast<double>(t) / rate_hz)));
    for (std::size_t j = 0; j < points; ++j) {
      const bool missing = random() % 5 == 0;
      out.frames.state.push_back(missing ? Tracking::missing : Tracking::tracked);
      for (int k = 0; k < 3; ++k) out.frames.positions.push_back(missing ? 0.0 : place(random));
    }
  }
  return out;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return HUGE_VAL;
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::fmax(most, std::abs(a[i] - b[i]));
  return most;
}

/// Writes positions.in and states.in for a script of tests/witness.
inline void put_points(const FreshFolder& folder, const PointFrames& frames) {
  std::vector<double> states;
  for (const Tracking state : frames.state) states.push_back(static_cast<double>(state));
  const auto put = [&](const char* name, const std::vector<double>& values) {
    folder.write(name, {reinterpret_cast<const char*>(values.data()), 8 * values.size()});
  };
  put("states.in", states);
  put("positions.in", frames.positions);
}

}  // namespace kinalign
