// SPDX-License-Identifier: Apache-2.0
// Rotations at 30 Hz give or take 12 ms onto 60 Hz: slerp against Eigen's, and the spline with
// continuous angular acceleration (its rates included) against slerp.
#include "kinalign/motion/arrays.h"
#include "kinalign/motion/interpolation/rotation_spline.h"
#include "kinalign/motion/interpolation/slerp.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::size_t knots = 30000, samples = 2 * knots - 1;

struct Data {
  std::vector<double> times = std::vector<double>(knots), at = std::vector<double>(samples);
  std::vector<double> rotations = std::vector<double>(4 * knots);
  std::vector<double> out = std::vector<double>(4 * samples);
  std::vector<Quat> eigen_rotations = std::vector<Quat>(knots);
  std::vector<Quat> eigen_out = std::vector<Quat>(samples);

  Data() {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < knots; ++i) {
      times[i] = static_cast<double>(i) / 30.0 + 0.004 * std::clamp(normal(random), -3.0, 3.0);
      Quat q(normal(random), normal(random), normal(random), normal(random));
      q.normalize();
      if (i > 0) q = eigen_rotations[i - 1].slerp(0.1, q);
      eigen_rotations[i] = q;
      put_quat(rotations, i, q);
    }
    for (std::size_t i = 0; i < samples; ++i) {
      at[i] = std::clamp(static_cast<double>(i) / 60.0, times.front(), times.back());
    }
  }
};

void count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}

void eigen_slerp(benchmark::State& state) {
  Data d;
  for (auto _ : state) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      while (k + 2 < knots && d.at[i] >= d.times[k + 1]) ++k;
      const double part = (d.at[i] - d.times[k]) / (d.times[k + 1] - d.times[k]);
      d.eigen_out[i] = d.eigen_rotations[k].slerp(part, d.eigen_rotations[k + 1]);
    }
    benchmark::DoNotOptimize(d.eigen_out.data());
  }
  count(state);
}

void slerp(benchmark::State& state) {
  Data d;
  for (auto _ : state) {
    slerp_at(d.times, d.rotations, d.at, d.out);
    benchmark::DoNotOptimize(d.out.data());
  }
  count(state);
}

void rotation_spline(benchmark::State& state) {
  Data d;
  const RotationKnots all{d.times, d.rotations};
  for (auto _ : state) {
    rotation_spline_at(all, d.at, d.out);
    benchmark::DoNotOptimize(d.out.data());
  }
  count(state);
}

BENCHMARK(eigen_slerp)->Name("slerp/eigen")->Unit(benchmark::kMillisecond);
BENCHMARK(slerp)->Name("slerp/kinalign")->Unit(benchmark::kMillisecond);
BENCHMARK(rotation_spline)->Name("rotation_spline/kinalign")->Unit(benchmark::kMillisecond);

}  // namespace
