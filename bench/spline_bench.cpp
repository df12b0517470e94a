// SPDX-License-Identifier: Apache-2.0
// 75 channels at 30 Hz give or take 12 ms onto 60 Hz by natural splines, in windows of 1000 rows as
// alignment does, against the same bytes moved, and against one channel after the other.
#include "kinalign/motion/interpolation/spline.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::size_t rows = 30000, channels = 75, samples = 2 * rows - 1, window = 1000;

struct Data {
  std::vector<double> times = std::vector<double>(rows), at = std::vector<double>(samples);
  std::vector<double> values = std::vector<double>(rows * channels);
  std::vector<double> bends = std::vector<double>(rows * channels);
  std::vector<double> out = std::vector<double>(samples * channels);

  Data() {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < rows; ++i) {
      times[i] = static_cast<double>(i) / 30.0 + 0.004 * std::clamp(normal(random), -3.0, 3.0);
    }
    for (auto& v : values) v = normal(random);
    for (std::size_t i = 0; i < samples; ++i) {
      at[i] = std::clamp(static_cast<double>(i) / 60.0, times.front(), times.back());
    }
  }
};

void count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples * channels));
}

/// Reads the values and writes bends and output: the memory traffic that any spline needs.
void traffic(benchmark::State& state) {
  Data d;
  for (auto _ : state) {
    double sum = 0.0;
    for (const double v : d.values) sum += v;
    const int byte = static_cast<int>(sum) & 1;
    std::memset(d.bends.data(), byte, d.bends.size() * sizeof(double));
    std::memset(d.out.data(), byte, d.out.size() * sizeof(double));
    benchmark::DoNotOptimize(sum);
    benchmark::ClobberMemory();
  }
  count(state);
}

void whole(benchmark::State& state) {
  Data d;
  const Knots knots{d.times, d.values, channels};
  for (auto _ : state) {
    natural_spline(knots, d.bends);
    spline_at(knots, d.bends, d.at, d.out);
    benchmark::DoNotOptimize(d.out.data());
  }
  count(state);
}

// Slab: the same rows are written again and again, as alignment does.
enum class Output { whole, slab };

template <Output output>
void windows(benchmark::State& state) {
  Data d;
  for (auto _ : state) {
    std::size_t sample = 0;
    for (std::size_t first = 0; first < rows; first += window) {
      const std::size_t begin = first < spline_reach ? 0 : first - spline_reach;
      const std::size_t end = std::min(rows, first + window + spline_reach);
      const Knots knots{std::span(d.times).subspan(begin, end - begin),
                        std::span(d.values).subspan(begin * channels, (end - begin) * channels),
                        channels};
      const std::size_t from = sample;
      const double until = first + window < rows ? d.times[first + window] : d.times.back() + 1.0;
      while (sample < samples && d.at[sample] < until) ++sample;
      natural_spline(knots, std::span(d.bends).first((end - begin) * channels));
      spline_at(knots, d.bends, std::span(d.at).subspan(from, sample - from),
                std::span(d.out).subspan(output == Output::whole ? from * channels : 0,
                                         (sample - from) * channels));
    }
    benchmark::DoNotOptimize(d.out.data());
  }
  count(state);
}

BENCHMARK(traffic)->Name("spline/traffic")->Unit(benchmark::kMillisecond);
BENCHMARK(whole)->Name("spline/kinalign")->Unit(benchmark::kMillisecond);
BENCHMARK(windows<Output::whole>)->Name("spline_windows/kinalign")->Unit(benchmark::kMillisecond);
BENCHMARK(windows<Output::slab>)->Name("spline_slabs/kinalign")->Unit(benchmark::kMillisecond);

}  // namespace
