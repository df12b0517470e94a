// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/uncertainty.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

// Chi-squared with three degrees of freedom: SciPy 1.10.1, chi2.ppf([0.5, 0.9, 0.95], 3).
constexpr double chi_50 = 2.3659738843753377, chi_90 = 6.251388631170325,
                 chi_95 = 7.814727903251179;

struct Cell {
  double sigma, square;  // m, m2
};

std::vector<Cell> cells_of(const Sequence& sequence, Prediction prediction, Sigmas sigmas) {
  assert(prediction.size() == sequence.truth.size() && sigmas.size() == sequence.valid.size());
  std::vector<Cell> out;
  for (std::size_t i = 0; i < sequence.valid.size(); ++i) {
    if (sequence.valid[i] == 0) continue;
    out.push_back({sigmas[i], (vec3(prediction, i) - vec3(sequence.truth, i)).squaredNorm()});
  }
  return out;
}

}  // namespace

std::optional<Coverage> coverage(const Sequence& sequence, Prediction prediction, Sigmas sigmas) {
  const std::vector<Cell> cells = cells_of(sequence, prediction, sigmas);
  if (cells.empty()) return std::nullopt;
  Mean in_50, in_90, in_95, sigma, likelihood, scaled;
  for (const Cell& cell : cells) {
    const double variance = cell.sigma * cell.sigma, chi = cell.square / variance;
    in_50.add(chi <= chi_50 ? 1.0 : 0.0);
    in_90.add(chi <= chi_90 ? 1.0 : 0.0);
    in_95.add(chi <= chi_95 ? 1.0 : 0.0);
    sigma.add(cell.sigma);
    likelihood.add(-1.5 * std::log(2.0 * std::numbers::pi * variance) - 0.5 * chi);
    scaled.add(chi / 3.0);
  }
  return Coverage{cells.size(),
                  in_50.value_or(0.0),
                  in_90.value_or(0.0),
                  in_95.value_or(0.0),
                  sigma.value_or(0.0),
                  likelihood.value_or(0.0),
                  std::sqrt(scaled.value_or(0.0))};
}

std::vector<SigmaDecile> sigma_deciles(const Sequence& sequence, Prediction prediction,
                                       Sigmas sigmas) {
  std::vector<Cell> cells = cells_of(sequence, prediction, sigmas);
  std::stable_sort(cells.begin(), cells.end(),
                   [](const Cell& a, const Cell& b) { return a.sigma < b.sigma; });
  std::vector<SigmaDecile> out;
  for (std::size_t d = 0; d < 10; ++d) {
    const std::size_t begin = d * cells.size() / 10, end = (d + 1) * cells.size() / 10;
    if (begin == end) continue;
    Mean sigma, square;
    for (std::size_t i = begin; i < end; ++i) {
      sigma.add(cells[i].sigma);
      square.add(cells[i].square / 3.0);
    }
    out.push_back({end - begin, sigma.value_or(0.0), std::sqrt(square.value_or(0.0))});
  }
  return out;
}

}  // namespace kinalign
