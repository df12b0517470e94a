// SPDX-License-Identifier: Apache-2.0
// Fits a robust line to each stretch between two resets of the sender's clock, as pyxdf does: Huber
// loss above 0.1 ms. See docs/formats/xdf.md.
#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/motion/median.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double reset_step = 1.0;      // s, pyxdf's clock_reset_threshold_offset_seconds
constexpr double huber_scale = 0.0001;  // s, pyxdf's winsor_threshold
constexpr int most_rounds = 1000;

using Offsets = std::span<const XdfClockOffset>;

enum class Step { none, outlier, reset };

/// Compares offset k with offset `before`, the last one that was no outlier.
/// A reset lasts: the next offset is nearer to the new level. An outlier is alone.
Step step_of(Offsets offsets, std::size_t before, std::size_t k) {
  const auto& level = offsets[before];
  const auto& now = offsets[k];
  // The sender's clock was set back.
  if (now.time < offsets[k - 1].time) return Step::reset;
  if (!(std::abs(now.offset - level.offset) > reset_step)) return Step::none;
  // The last offset has no next one to compare with.
  if (k + 1 == offsets.size()) return Step::reset;
  const double next = offsets[k + 1].offset;
  const bool stays = std::abs(next - now.offset) <= std::abs(next - level.offset);
  return stays ? Step::reset : Step::outlier;
}

double residual(const XdfClockLine& line, const XdfClockOffset& o) {
  return o.offset - (line.offset + line.slope * (o.time - line.origin));
}

/// One round of the weighted fit. The weights are Huber's for the residuals of `line`.
/// Sums of the normal equations of a straight line.
XdfClockLine next_round(const XdfClockLine& line, Offsets offsets) {
  double w = 0.0, wx = 0.0, wy = 0.0, wxx = 0.0, wxy = 0.0;
  for (const auto& o : offsets) {
    const double r = std::abs(residual(line, o)), x = o.time - line.origin;
    // Huber: full weight near the line, and less the farther away.
    const double weight = r <= huber_scale ? 1.0 : huber_scale / r;
    w += weight;
    wx += weight * x;
    wy += weight * o.offset;
    wxx += weight * x * x;
    wxy += weight * x * o.offset;
  }
  XdfClockLine next = line;
  // 0 if all times are equal; then only the level can be fitted.
  const double spread = wxx - wx * wx / w;
  next.slope = spread > 0.0 ? (wxy - wx * wy / w) / spread : 0.0;
  next.offset = (wy - next.slope * wx) / w;
  return next;
}

/// Fits a line, starting from the median offset with slope 0, until it moves by less than rounding
/// errors.
/// Each round weighs with the residuals of the one before (iteratively reweighted least squares).
XdfClockLine fit_line(Offsets offsets) {
  XdfClockLine line;
  line.first = offsets.front().time;
  line.last = offsets.back().time;
  // Times count from the middle, so that offset and slope hardly depend on each other.
  line.origin = line.first + (line.last - line.first) / 2;
  line.offsets = offsets.size();
  std::vector<double> values;
  for (const auto& o : offsets) values.push_back(o.offset);
  line.offset = upper_median(values);
  for (int round = 0; round < most_rounds; ++round) {
    const XdfClockLine next = next_round(line, offsets);
    // The largest movement within the stretch.
    const double half = (line.last - line.first) / 2;
    const double moved =
        std::abs(next.offset - line.offset) + std::abs(next.slope - line.slope) * half;
    line = next;
    if (moved <= 1e-12 + 1e-13 * std::abs(line.offset)) break;
  }
  // Over all offsets: outliers are to be seen in the report.
  double squares = 0.0;
  for (const auto& o : offsets) {
    const double r = residual(line, o);
    squares += r * r;
    line.largest_residual = std::max(line.largest_residual, std::abs(r));
  }
  line.rms_residual = std::sqrt(squares / static_cast<double>(offsets.size()));
  return line;
}

double distance(const XdfClockLine& line, double stamp) {
  return std::max({line.first - stamp, stamp - line.last, 0.0});
}

}  // namespace

// `level` is the last offset that was no outlier.
std::vector<XdfClockLine> fit_xdf_clock(Offsets offsets) {
  std::vector<XdfClockLine> lines;
  std::size_t begin = 0, level = 0;
  for (std::size_t k = 1; k <= offsets.size(); ++k) {
    // The end closes the last stretch.
    const Step step = k < offsets.size() ? step_of(offsets, level, k) : Step::reset;
    if (step != Step::outlier) level = k;
    if (step != Step::reset) continue;
    // An outlier belongs to its stretch; the loss limits its influence.
    lines.push_back(fit_line(offsets.subspan(begin, k - begin)));
    begin = k;
  }
  return lines;
}

double corrected_xdf_stamp(std::span<const XdfClockLine> lines, double stamp) {
  const XdfClockLine* nearest = nullptr;
  for (const XdfClockLine& line : lines) {
    // "<=": if two lines are equally near, the later one is taken.
    if (nearest == nullptr || distance(line, stamp) <= distance(*nearest, stamp)) nearest = &line;
  }
  if (nearest == nullptr) return stamp;
  return stamp + nearest->offset + nearest->slope * (stamp - nearest->origin);
}

}  // namespace kinalign
