// SPDX-License-Identifier: Apache-2.0
// An invented truth and a prediction near it, for metrics.
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace kinalign {

inline double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

inline constexpr std::array<Bone, 4> some_bones{{{4, 5}, {5, 6}, {10, 11}, {11, 12}}};
inline constexpr std::array<std::size_t, 2> two_feet{13, 17};

struct MovingBody {
  std::size_t joints = 18;
  double rate_hz = 30.0;
  std::vector<double> truth, prediction;  // [T,J,3] m
  std::vector<std::uint8_t> valid;        // [T,J]

  Sequence sequence() const { return {joints, rate_hz, truth, valid}; }
};

/// Joints that swing about places of their own; the prediction is `noise_m` off on each axis. About
/// one cell in twenty is not valid, but all cells of frame 0 are.
inline MovingBody moving_body(std::uint64_t seed, std::size_t frames = 80, double noise_m = 0.03) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, noise_m), place(0.0, 0.5);
  std::uniform_real_distribution<double> phase(0.0, 6.28);
  MovingBody out;
  std::vector<double> middle, angle;
  for (std::size_t c = 0; c < 3 * out.joints; ++c) {
    middle.push_back(place(random));
    angle.push_back(phase(random));
  }
  for (std::size_t t = 0; t < frames; ++t) {
    for (std::size_t c = 0; c < 3 * out.joints; ++c) {
      const double seconds = static_cast<double>(t) / out.rate_hz;
      out.truth.push_back(
          middle[c] +
          0.2 * std::sin((1.0 + 0.1 * static_cast<double>(c % 7)) * seconds * seconds + angle[c]));
      out.prediction.push_back(out.truth.back() + noise(random));
    }
    for (std::size_t j = 0; j < out.joints; ++j) {
      out.valid.push_back(t > 0 && random() % 20 == 0 ? 0 : 1);
    }
  }
  return out;
}

}  // namespace kinalign
