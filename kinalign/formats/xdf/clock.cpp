// SPDX-License-Identifier: Apache-2.0
// Fits a robust line to the offsets of a sender's clock, as pyxdf does, with Huber loss above 0.1
// ms. Each stretch between two resets of the clock gets its own line. See docs/formats/xdf.md.
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

/// Compares offset k with offset `before`, the last one that is not an outlier. After a reset, the
/// next offset is nearer to the new value. After an outlier, it is nearer to the old value.
Step step_of(Offsets offsets, std::size_t before, std::size_t k) {
  const auto& level = offsets[before];
  const auto& now = offsets[k];
  // The time stepped back, so the sender's clock was reset.
  if (now.time < offsets[k - 1].time) return Step::reset;
  if (!(std::abs(now.offset - level.offset) > reset_step)) return Step::none;
  // There is no next offset for the comparison.
  if (k + 1 == offsets.size()) return Step::reset;
  const double next = offsets[k + 1].offset;
  const bool stays = std::abs(next - now.offset) <= std::abs(next - level.offset);
  return stays ? Step::reset : Step::outlier;
}

double residual(const XdfClockLine& line, const XdfClockOffset& o) {
  return o.offset - (line.offset + line.slope * (o.time - line.origin));
}

/// One round of the weighted fit of a straight line, by its normal equations. The weights are
/// Huber's for the residuals of `line`.
XdfClockLine next_round(const XdfClockLine& line, Offsets offsets) {
  double w = 0.0, wx = 0.0, wy = 0.0, wxx = 0.0, wxy = 0.0;
  for (const auto& o : offsets) {
    const double r = std::abs(residual(line, o)), x = o.time - line.origin;
    // Huber's weight is 1 for small residuals, and decreases for larger ones.
    const double weight = r <= huber_scale ? 1.0 : huber_scale / r;
    w += weight;
    wx += weight * x;
    wy += weight * o.offset;
    wxx += weight * x * x;
    wxy += weight * x * o.offset;
  }
  XdfClockLine next = line;
  // If all times are equal, the spread is 0 and only the offset can be fitted.
  const double spread = wxx - wx * wx / w;
  next.slope = spread > 0.0 ? (wxy - wx * wy / w) / spread : 0.0;
  next.offset = (wy - next.slope * wx) / w;
  return next;
}

/// Fits a line by iteratively reweighted least squares: each round uses the residuals of the
/// previous round. It begins with the median offset and slope 0. It ends when the line changes by
/// less than rounding errors.
XdfClockLine fit_line(Offsets offsets) {
  XdfClockLine line;
  line.first = offsets.front().time;
  line.last = offsets.back().time;
  // Times count from the middle of the stretch, so that offset and slope are nearly independent.
  line.origin = line.first + (line.last - line.first) / 2;
  line.offsets = offsets.size();
  std::vector<double> values;
  for (const auto& o : offsets) values.push_back(o.offset);
  line.offset = upper_median(values);
  for (int round = 0; round < most_rounds; ++round) {
    const XdfClockLine next = next_round(line, offsets);
    // The largest change of the line within the stretch.
    const double half = (line.last - line.first) / 2;
    const double moved =
        std::abs(next.offset - line.offset) + std::abs(next.slope - line.slope) * half;
    line = next;
    if (moved <= 1e-12 + 1e-13 * std::abs(line.offset)) break;
  }
  // The residual includes outliers, because the report must show them.
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

// `level` is the last offset that is not an outlier.
std::vector<XdfClockLine> fit_xdf_clock(Offsets offsets) {
  std::vector<XdfClockLine> lines;
  std::size_t begin = 0, level = 0;
  for (std::size_t k = 1; k <= offsets.size(); ++k) {
    // The last stretch ends at the end of the offsets.
    const Step step = k < offsets.size() ? step_of(offsets, level, k) : Step::reset;
    if (step != Step::outlier) level = k;
    if (step != Step::reset) continue;
    // An outlier stays in its stretch. The robust fit limits its influence.
    lines.push_back(fit_line(offsets.subspan(begin, k - begin)));
    begin = k;
  }
  return lines;
}

double corrected_xdf_stamp(std::span<const XdfClockLine> lines, double stamp) {
  const XdfClockLine* nearest = nullptr;
  for (const XdfClockLine& line : lines) {
    // Because of "<=", the later of two equally near lines is used.
    if (nearest == nullptr || distance(line, stamp) <= distance(*nearest, stamp)) nearest = &line;
  }
  if (nearest == nullptr) return stamp;
  return stamp + nearest->offset + nearest->slope * (stamp - nearest->origin);
}

}  // namespace kinalign
