// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/spline.h"

#include "kinalign/motion/targets.h"

#include <algorithm>
#include <vector>

namespace kinalign {

namespace {

/// Prefetches the row after the next one, because the processor does not do so for short rows. This
/// saves 4 % of the time.
KA_INLINE void prefetch(const double* row, std::size_t channels) {
  for (std::size_t c = 0; c < channels; c += 8) __builtin_prefetch(row + c);
}

// Eliminates the tridiagonal system row by row, for all channels of a row together: bend[i] = (6
// (slope after - slope before) - h_before * bend[i-1]) / pivot[i].
KA_EVERY_PROCESSOR
void eliminate(const Knots& knots, double* ratio, double* bends) {
  const auto& t = knots.times;
  const double* values = knots.values.data();
  const std::size_t channels = knots.channels;
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
    // The pivot of the row is 2 (before + after), less the part that was eliminated.
    const double scale = 1.0 / (2.0 * (before + after) - before * ratio[i - 1]);
    ratio[i] = after * scale;
    const double to_before = 6.0 * scale / before, to_after = 6.0 * scale / after;
    const double carry = before * scale;
    const double *y0 = values + (i - 1) * channels, *y1 = y0 + channels, *y2 = y1 + channels;
    const double* above = bends + (i - 1) * channels;
    double* bend = bends + i * channels;
    prefetch(y2 + 2 * channels, channels);
#pragma GCC ivdep
    for (std::size_t c = 0; c < channels; ++c) {
      bend[c] = (y2[c] - y1[c]) * to_after - (y1[c] - y0[c]) * to_before - carry * above[c];
    }
  }
}

KA_EVERY_PROCESSOR
void substitute(const double* ratio, std::size_t rows, std::size_t channels, double* bends) {
  for (std::size_t i = rows - 2; i > 0; --i) {
    double* bend = bends + i * channels;
    const double* below = bend + channels;
#pragma GCC ivdep
    for (std::size_t c = 0; c < channels; ++c) bend[c] -= ratio[i] * below[c];
  }
}

/// A place between two knots: the weights of both values and of both second derivatives.
struct Place {
  double left, right, left_bend, right_bend;
};

Place place_in(double from, double to, double at) {
  const double h = to - from, right = (at - from) / h, left = 1.0 - right;
  const double sixth = h * h * (1.0 / 6.0);
  return {left, right, (left * left * left - left) * sixth,
          (right * right * right - right) * sixth};
}

/// Fills `out` with all channels at rising places, from the knots' values and second derivatives.
KA_EVERY_PROCESSOR
void blend(const Knots& knots, const double* bends, std::span<const double> at, double* out) {
  const auto& t = knots.times;
  const std::size_t channels = knots.channels;
  std::size_t k = 0;
  for (std::size_t i = 0; i < at.size(); ++i, out += channels) {
    while (k + 2 < t.size() && at[i] >= t[k + 1]) ++k;
    const Place w = place_in(t[k], t[k + 1], at[i]);
    const double *y = &knots.values[k * channels], *bend = bends + k * channels;
    const double *y1 = y + channels, *bend1 = bend + channels;
#pragma GCC ivdep
    for (std::size_t c = 0; c < channels; ++c) {
      out[c] = w.left * y[c] + w.right * y1[c] + (w.left_bend * bend[c] + w.right_bend * bend1[c]);
    }
  }
}

}  // namespace

void natural_spline(const Knots& knots, std::span<double> bends) {
  const std::size_t rows = knots.times.size(), channels = knots.channels;
  const auto first = bends.first(channels), last = bends.subspan((rows - 1) * channels, channels);
  std::fill(first.begin(), first.end(), 0.0);
  std::fill(last.begin(), last.end(), 0.0);
  // With one or two knots the curve is a constant or a straight line.
  if (rows < 3) return;
  std::vector<double> ratio(rows, 0.0);
  eliminate(knots, ratio.data(), bends.data());
  substitute(ratio.data(), rows, channels, bends.data());
}

void spline_at(const Knots& knots, std::span<const double> bends, std::span<const double> times,
               std::span<double> out) {
  if (knots.times.size() > 1) return blend(knots, bends.data(), times, out.data());
  for (std::size_t i = 0; i < times.size(); ++i) {
    std::copy_n(knots.values.begin(), knots.channels, &out[i * knots.channels]);
  }
}

}  // namespace kinalign
