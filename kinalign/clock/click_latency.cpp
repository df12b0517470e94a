// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/click_latency.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace kinalign {

namespace {

constexpr double normal_from_mad = 1.4826;
constexpr double outside = 0.05;

/// Returns the median of values in rising order.
Duration median_of(const std::vector<Duration>& sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half]
                                : sorted[half - 1] + (sorted[half] - sorted[half - 1]) / 2;
}

/// Number of values that may be outside the interval at each end, from the binomial distribution
/// for n fair coins.
std::size_t left_out(std::size_t n) {
  double probability = std::pow(0.5, static_cast<double>(n));  // probability of tails only
  double below = 2.0 * probability;
  std::size_t k = 0;
  while (below <= outside) {
    ++k;
    probability *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    below += 2.0 * probability;
  }
  return k - 1;
}

}  // namespace

std::optional<ClickLatency> click_latency(std::span<const ClickPair> pairs) {
  if (pairs.size() < least_click_pairs) return std::nullopt;
  std::vector<Duration> lags, deviations;
  for (const ClickPair& pair : pairs) lags.push_back(pair.response - pair.click);
  std::sort(lags.begin(), lags.end());
  ClickLatency found;
  found.median = median_of(lags);
  for (const Duration lag : lags) deviations.push_back(std::chrono::abs(lag - found.median));
  std::sort(deviations.begin(), deviations.end());
  found.spread =
      Duration{std::llround(normal_from_mad * static_cast<double>(median_of(deviations).count()))};
  const std::size_t k = left_out(lags.size());
  found.low = lags[k];
  found.high = lags[lags.size() - 1 - k];
  return found;
}

std::optional<ClickedStep> clicked_step(std::span<const ClickedTake> takes) {
  const auto n = static_cast<double>(takes.size());
  if (takes.size() < 3) return std::nullopt;
  double mean_frames = 0.0, mean_length = 0.0;
  for (const ClickedTake& take : takes) {
    mean_frames += static_cast<double>(take.frames) / n;
    mean_length += seconds(take.stop - take.start) / n;
  }
  double squares = 0.0, products = 0.0;
  for (const ClickedTake& take : takes) {
    const double f = static_cast<double>(take.frames) - mean_frames;
    squares += f * f;
    products += f * (seconds(take.stop - take.start) - mean_length);
  }
  if (squares == 0.0) return std::nullopt;
  ClickedStep found;
  found.step_s = products / squares;
  found.latency_difference_s = mean_length - found.step_s * mean_frames;
  double residuals = 0.0;
  for (const ClickedTake& take : takes) {
    const double r = seconds(take.stop - take.start) - found.latency_difference_s -
                     found.step_s * static_cast<double>(take.frames);
    residuals += r * r;
  }
  const double variance = residuals / (n - 2.0);
  found.step_deviation_s = std::sqrt(variance / squares);
  found.latency_deviation_s = std::sqrt(variance * (1.0 / n + mean_frames * mean_frames / squares));
  return found;
}

}  // namespace kinalign
