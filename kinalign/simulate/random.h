// SPDX-License-Identifier: Apache-2.0
// Random numbers by counter. Number k of a stream is a function of (seed, stream, k, lane). It
// therefore does not depend on the order of calls or on the number of threads. The mixing function
// is that of SplitMix64 (Steele, Lea, Flood, «Fast splittable pseudorandom number generators»,
// 2014).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace kinalign {

constexpr std::uint64_t mix64(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

/// One stream of a seed: numbers k = 0, 1, … in 16 independent lanes.
class RandomStream {
 public:
  constexpr RandomStream(std::uint64_t seed, std::uint64_t stream)
      : base_(mix64(mix64(seed) ^ stream)) {}

  /// Returns a uniform number in (0, 1).
  constexpr double uniform(std::uint64_t k, std::uint64_t lane) const {
    return (static_cast<double>(mix64(base_ + 16 * k + lane) >> 11) + 0.5) * 0x1p-53;
  }
  double exponential(std::uint64_t k, std::uint64_t lane, double mean) const {
    return -mean * std::log(uniform(k, lane));
  }
  /// Standard normal, from lanes `lane` and `lane` + 1 (Box and Muller).
  double normal(std::uint64_t k, std::uint64_t lane) const {
    return std::sqrt(-2.0 * std::log(uniform(k, lane))) *
           std::cos(2.0 * std::numbers::pi * uniform(k, lane + 1));
  }
  /// Two independent standard normal numbers from the same two lanes.
  std::pair<double, double> normals(std::uint64_t k, std::uint64_t lane) const {
    const double radius = std::sqrt(-2.0 * std::log(uniform(k, lane)));
    const double angle = 2.0 * std::numbers::pi * uniform(k, lane + 1);
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
  bool chance(std::uint64_t k, std::uint64_t lane, double probability) const {
    return uniform(k, lane) < probability;
  }

 private:
  std::uint64_t base_;
};

}  // namespace kinalign
