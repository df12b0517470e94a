// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/uncertainty.h"

#include <algorithm>

namespace kinalign {

namespace {

// The bins of one millimetre cover errors up to two metres.
constexpr std::size_t most_bins = 2000;

}  // namespace

void RadiusMarks::add(double error_m, double radius_m) {
  ++cells;
  if (error_m <= radius_m) ++within;
  sum_m += radius_m;
  const double last = most_bins - 1;
  const auto bin = static_cast<std::size_t>(std::clamp(1000.0 * error_m, 0.0, last));
  // The histogram grows only as far as the largest error, so it is short for an accurate method.
  if (errors.size() <= bin) errors.resize(bin + 1);
  ++errors[bin];
}

/// Shorter histograms are extended with zeros.
void RadiusMarks::add(const RadiusMarks& other) {
  cells += other.cells;
  within += other.within;
  sum_m += other.sum_m;
  if (errors.size() < other.errors.size()) errors.resize(other.errors.size());
  for (std::size_t e = 0; e < other.errors.size(); ++e) errors[e] += other.errors[e];
}

double RadiusMarks::covered() const {
  return cells == 0 ? 0.0 : static_cast<double>(within) / static_cast<double>(cells);
}

double RadiusMarks::mean_radius_m() const {
  return cells == 0 ? 0.0 : sum_m / static_cast<double>(cells);
}

/// Counts up the histogram until as many errors are included as lie within the stated radii.
double RadiusMarks::one_radius_m() const {
  std::size_t held = 0, bin = 0;
  while (bin < errors.size() && held < within) held += errors[bin++];
  return 0.001 * static_cast<double>(bin);
}

}  // namespace kinalign
