// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <random>

namespace kinalign {

namespace {

// Beyond this number of pairs the normal approximation is used (statistics.h).
constexpr std::size_t most_exact = 50;

/// The differences that are not 0, sorted by absolute value.
std::vector<double> by_size(std::span<const double> differences) {
  std::vector<double> out;
  for (const double d : differences) {
    if (d != 0.0) out.push_back(d);
  }
  std::sort(out.begin(), out.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return out;
}

/// The sums of Wilcoxon's ranks. The negative sum is all minus positive.
struct RankSums {
  double positive = 0.0, all = 0.0;
  double ties = 0.0;  // sum of t^3 - t over groups of t equal sizes
};

/// Ranks the differences. Equal absolute values share the mean of their ranks.
RankSums rank_sums(const std::vector<double>& sorted) {
  RankSums out;
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin;
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[begin])) ++end;
    const auto t = static_cast<double>(end - begin);
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) {
      if (sorted[i] > 0.0) out.positive += rank;
    }
    out.all += rank * t;
    out.ties += t * t * t - t;
    begin = end;
  }
  return out;
}

/// Twice the probability that a sum of ranks is at most `statistic`, if each rank 1 … n is included
/// or not with equal probability. The distribution is built rank by rank: each rank shifts half of
/// it.
double exact_p(std::size_t n, double statistic) {
  std::vector<double> chances(n * (n + 1) / 2 + 1);
  chances[0] = 1.0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t sum = chances.size(); sum-- > 0;) {
      chances[sum] = 0.5 * (chances[sum] + (sum >= rank ? chances[sum - rank] : 0.0));
    }
  }
  const auto end = static_cast<std::ptrdiff_t>(std::floor(statistic)) + 1;
  return std::min(1.0, 2.0 * std::accumulate(chances.begin(), chances.begin() + end, 0.0));
}

/// The two-sided p of the normal approximation. Ties make the variance smaller (Wilcoxon's
/// correction).
double normal_p(std::size_t pairs, double statistic, double ties) {
  const auto n = static_cast<double>(pairs);
  const double mean = n * (n + 1.0) / 4.0;
  const double square = (n * (n + 1.0) * (2.0 * n + 1.0) - 0.5 * ties) / 24.0;
  return std::erfc(std::abs(statistic - mean) / std::sqrt(2.0 * square));
}

/// A random number below n, the same with every standard library.
std::size_t drawn(std::mt19937_64& random, std::size_t n) {
  // Larger numbers are rejected, so that all results are equally likely.
  const std::uint64_t whole = UINT64_MAX - UINT64_MAX % n;
  std::uint64_t number = random();
  while (number >= whole) number = random();
  return number % n;
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  assert(!values.empty());
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
  // The next larger value is the smallest of the values that nth_element put after `at`.
  std::nth_element(values.begin(), at, values.end());
  const double share = place - static_cast<double>(below);
  if (share == 0.0) return *at;
  return *at + share * (*std::min_element(at + 1, values.end()) - *at);
}

std::optional<double> mean_of(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(std::span<const double> values) {
  assert(!values.empty());
  const double mean = *mean_of(values);
  double square = 0.0;
  for (const double v : values) square += (v - mean) * (v - mean);
  return std::sqrt(square / static_cast<double>(values.size()));
}

WilcoxonTest wilcoxon_signed_rank(std::span<const double> differences) {
  const std::vector<double> sorted = by_size(differences);
  const std::size_t n = sorted.size();
  // If nothing differs, no test is possible: p stays 1.
  if (n == 0) return {};
  const RankSums sums = rank_sums(sorted);
  const double statistic = std::min(sums.positive, sums.all - sums.positive);
  const bool exact = n <= most_exact && n == differences.size() && sums.ties == 0.0;
  return {n, statistic, exact ? exact_p(n, statistic) : normal_p(n, statistic, sums.ties)};
}

/// The k-th smallest p is multiplied by the number of tests that remain. A corrected value is at
/// most 1.
std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [p](auto a, auto b) { return p[a] < p[b]; });
  std::vector<double> out(p.size());
  double least = 0.0;  // the corrected values never decrease in the order of p
  for (std::size_t k = 0; k < order.size(); ++k) {
    least = std::max(least, std::min(1.0, p[order[k]] * static_cast<double>(p.size() - k)));
    out[order[k]] = least;
  }
  return out;
}

MeanInterval bootstrap_mean(std::span<const double> people, const BootstrapOptions& options) {
  assert(!people.empty() && options.draws > 0);
  std::mt19937_64 random(options.seed);
  std::vector<double> means(options.draws);
  for (double& mean : means) {
    double sum = 0.0;
    for (std::size_t i = 0; i < people.size(); ++i) sum += people[drawn(random, people.size())];
    mean = sum / static_cast<double>(people.size());
  }
  const double tail = 0.5 * (1.0 - options.level);
  return {mean_of(people).value_or(0.0), quantile(means, tail), quantile(means, 1.0 - tail)};
}

}  // namespace kinalign
