// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/coarse_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kinalign {

namespace {

// Share of the rms. Smaller losses are below the accuracy of sensors.
constexpr double least_share = 0.1;

double root_mean(double sum, std::uint64_t samples) {
  return samples == 0 ? 0.0 : std::sqrt(std::max(0.0, sum) / static_cast<double>(samples));
}

/// Returns Lagrange's weights for the times `at`. With these weights, four values give the value at
/// `t` of the cubic through them.
std::array<double, 4> cubic_weights(const double* at, double t) {
  std::array<double, 4> weights{1.0, 1.0, 1.0, 1.0};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (k != i) weights[i] *= (t - at[k]) / (at[i] - at[k]);
    }
  }
  return weights;
}

}  // namespace

double CarriedContent::variation() const {
  double about_mean = squares;
  // The mean square about the mean is the mean square minus the square of the mean.
  for (const double s : sum) about_mean -= s * s / static_cast<double>(samples);
  return root_mean(about_mean, samples);
}

double CarriedContent::missing() const { return root_mean(lost, samples); }

void add_content(const Knots& raw, const Knots& rows, std::size_t first, CarriedContent& content) {
  const std::span<const double> at = rows.times;
  if (at.size() < 4) return;
  std::size_t right = 2;  // index of the row after the sample
  for (std::size_t k = 0; k < raw.times.size(); ++k) {
    const double t = raw.times[k];
    // The cubic needs one row before and one after the interval, so the first and the last interval
    // are omitted.
    if (t < at[1]) continue;
    // Both lists rise, so the search continues from the last position.
    while (right + 1 < at.size() && at[right] <= t) ++right;
    if (right + 1 >= at.size()) return;
    const auto weights = cubic_weights(&at[right - 2], t);
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = raw.values[k * raw.channels + first + c];
      double read = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        read += weights[i] * rows.values[(right - 2 + i) * rows.channels + first + c];
      }
      content.sum[c] += value;
      content.squares += value * value;
      content.lost += (value - read) * (value - read);
    }
    ++content.samples;
  }
}

Findings judge_carried(const std::vector<CarriedContent>& contents, const ContentNames& names) {
  // `worst` becomes the share of the worst part so far.
  double worst = least_share;
  std::size_t part = contents.size();
  for (std::size_t k = 0; k < contents.size(); ++k) {
    const double lost = contents[k].missing(), all = contents[k].variation();
    // A sensor at rest varies only by its noise, which does not count as motion.
    if (lost <= names.noise || lost <= worst * all) continue;
    // If the difference is at least as large as the variation, the whole motion counts as lost.
    worst = all > lost ? lost / all : 1.0;
    part = k;
  }
  if (part == contents.size()) return {};
  return {
      {Severity::warning,
       Error{names.stream, 0, "a grid that can represent the stream's content",
             fmt::format("{:.0f} % of the rms of {}'s {} above what a {:.4g} Hz grid can represent",
                         100.0 * worst, names.parts[part], names.quantity, names.grid_hz)},
       "fast changes between the rows of the take are lost or look slower",
       "choose a faster stream as the reference, or use this stream's original file"}};
}

}  // namespace kinalign
