// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/spline.h"

#include "kinalign/motion/targets.h"

#include <algorithm>
#include <vector>

namespace kinalign {

namespace {

// Forward step of the tridiagonal system, for a row of channels:
// below[c] = (6 (slope after - slope before) - h_before * below_before[c]) / pivot.
KA_EVERY_PROCESSOR
void eliminate(const double* y, std::size_t channels, double before, double after, double pivot,
               const double* below, double* out) {
  const double to_before = 6.0 / before, to_after = 6.0 / after, scale = 1.0 / pivot;
  const double *y0 = y - channels, *y2 = y + channels;
  for (std::size_t c = 0; c < channels; ++c) {
    out[c] = ((y2[c] - y[c]) * to_after - (y[c] - y0[c]) * to_before - before * below[c]) * scale;
  }
}

KA_EVERY_PROCESSOR
void substitute(std::size_t channels, double ratio, const double* above, double* bend) {
  for (std::size_t c = 0; c < channels; ++c) bend[c] -= ratio * above[c];
}

struct Weights {
  double left, right, left_bend, right_bend;
};

KA_EVERY_PROCESSOR
void blend(const double* y, const double* bend, std::size_t channels, const Weights& w,
           double* out) {
  const double *y1 = y + channels, *bend1 = bend + channels;
  for (std::size_t c = 0; c < channels; ++c) {
    out[c] = w.left * y[c] + w.right * y1[c] + (w.left_bend * bend[c] + w.right_bend * bend1[c]);
  }
}

}  // namespace

void natural_spline(const Knots& knots, std::span<double> bends) {
  const auto& t = knots.times;
  const std::size_t n = t.size(), channels = knots.channels;
  std::fill(bends.begin(), bends.end(), 0.0);
  if (n < 3) return;
  std::vector<double> ratio(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
    const double pivot = 2.0 * (before + after) - before * ratio[i - 1];
    ratio[i] = after / pivot;
    eliminate(&knots.values[i * channels], channels, before, after, pivot,
              &bends[(i - 1) * channels], &bends[i * channels]);
  }
  for (std::size_t i = n - 2; i > 0; --i) {
    substitute(channels, ratio[i], &bends[(i + 1) * channels], &bends[i * channels]);
  }
}

void spline_at(const Knots& knots, std::span<const double> bends, std::span<const double> times,
               std::span<double> out) {
  const auto& t = knots.times;
  const std::size_t n = t.size(), channels = knots.channels;
  if (n == 1) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      std::copy_n(knots.values.begin(), channels, &out[i * channels]);
    }
    return;
  }
  std::size_t k = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    while (k + 2 < n && times[i] >= t[k + 1]) ++k;
    const double h = t[k + 1] - t[k];
    const double right = (times[i] - t[k]) / h, left = (t[k + 1] - times[i]) / h;
    const double sixth = h * h / 6.0;
    const Weights weights{left, right, (left * left * left - left) * sixth,
                          (right * right * right - right) * sixth};
    blend(&knots.values[k * channels], &bends[k * channels], channels, weights, &out[i * channels]);
  }
}

}  // namespace kinalign
