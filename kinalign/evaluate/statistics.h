// SPDX-License-Identifier: Apache-2.0
// Statistics over sequences and people: quantiles, paired tests, intervals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// The quantile q in [0, 1], interpolated linearly between two values, as NumPy's default.
double quantile(std::vector<double> values, double q);
/// The mean; absent without values.
std::optional<double> mean_of(std::span<const double> values);
/// The population's standard deviation (divides by n).
double deviation(std::span<const double> values);

/// A paired test that assumes no distribution: errors of methods are skewed, and people are few.
struct WilcoxonTest {
  std::size_t pairs = 0;   // differences that are not 0
  double statistic = 0.0;  // the smaller sum of ranks
  double p = 1.0;          // two-sided
};
/// Wilcoxon's signed-rank test of paired differences. Differences of 0 are left out. Exact for up
/// to 50 pairs without ties and zeros; otherwise the normal approximation with correction for ties.
WilcoxonTest wilcoxon_signed_rank(std::span<const double> differences);

/// Holm's correction (Scand. J. Stat. 6, 1979) of the p values of several tests; the order is kept.
std::vector<double> holm(std::span<const double> p);

/// A mean with its confidence interval. BootstrapOptions::level is the interval's probability.
struct MeanInterval {
  double mean = 0.0, low = 0.0, high = 0.0;
};
struct BootstrapOptions {
  std::uint64_t seed = 1;
  std::size_t draws = 10'000;
  double level = 0.95;
};
/// The mean over people (one value each) and its bootstrap percentile interval: people are drawn
/// with replacement. The same seed gives the same interval. With fewer than 8 people, print their
/// values instead.
MeanInterval bootstrap_mean(std::span<const double> people, const BootstrapOptions& options = {});

}  // namespace kinalign
