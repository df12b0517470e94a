// SPDX-License-Identifier: Apache-2.0
// The rates at the knots. Symbols as in "Smooth Attitude Interpolation" (see the header), for the
// interval from knot k to k + 1: r its rotation vector, h its length; W(r) turns the derivative of
// a rotation vector into an angular rate, W(r)^-1 back. Continuous angular acceleration at knot k
// demands
//   2/h' W(r') w[k-1] + 4 (1/h' + 1/h) w[k] + 2/h W(r)^-1 w[k+1]
//       = 6 (r'/h'^2 + r/h^2) - b(r', w[k])
// with ' for the interval before; b is quadratic in the rate and is iterated.
#include "kinalign/motion/rotation_spline.h"

#include "kinalign/motion/rotation_intervals.h"
#include "kinalign/motion/targets.h"
#include "kinalign/motion/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinalign {

namespace {

// The rows of the system depend on each other one after the other. So it is cut into eight pieces,
// which are solved side by side as vector code: each with some rows of its neighbours, whose rates
// beyond come from the sweep before. What that leaves, less than 1e-14 of a change, the next
// sweep takes away with the rest.
constexpr std::size_t overlap = 32;

struct Pieces {
  std::size_t rows = 0;                      // of each
  std::array<std::size_t, lanes> begin{};    // first row
  std::array<std::size_t, lanes + 1> own{};  // rows [own[i], own[i+1]) count from piece i
};

Pieces cut(std::size_t inner) {
  Pieces pieces;
  pieces.rows = std::min(inner, (inner + lanes - 1) / lanes + 2 * overlap);
  for (std::size_t i = 0; i <= lanes; ++i) pieces.own[i] = inner * i / lanes;
  for (std::size_t i = 0; i < lanes; ++i) {
    const std::size_t from = pieces.own[i] < overlap ? 0 : pieces.own[i] - overlap;
    pieces.begin[i] = std::min(from, inner - pieces.rows);
  }
  return pieces;
}

/// scale * (1 + first * r x . + second * r x (r x .)).
KA_INLINE Matrix about(const VectorLanes& r, std::size_t i, double first, double second,
                       double scale) {
  const double x = r[0][i], y = r[1][i], z = r[2][i];
  const double sx = scale * second * x, sy = scale * second * y, sz = scale * second * z;
  const double fx = scale * first * x, fy = scale * first * y, fz = scale * first * z;
  return {scale - sy * y - sz * z, sx * y - fz, sx * z + fy, sx * y + fz,
          scale - sx * x - sz * z, sy * z - fx, sx * z - fy, sy * z + fx,
          scale - sx * x - sy * y};
}

/// (diagonal * 1 - m)^-1, by cofactors.
KA_INLINE Matrix inverse_of_difference(double diagonal, const Matrix& m) {
  const double a = diagonal - m.xx, e = diagonal - m.yy, i = diagonal - m.zz;
  const double b = -m.xy, c = -m.xz, d = -m.yx, f = -m.yz, g = -m.zx, h = -m.zy;
  const double ca = e * i - f * h, cb = f * g - d * i, cc = d * h - e * g;
  const double scale = 1.0 / (a * ca + b * cb + c * cc);
  return {scale * ca, scale * (c * h - b * i), scale * (b * f - c * e),
          scale * cb, scale * (a * i - c * g), scale * (c * d - a * f),
          scale * cc, scale * (b * g - a * h), scale * (a * e - b * d)};
}

/// One row of the system, at knot k, of each piece.
struct Row {
  // Of the right side 6 (r'/h'^2 + r/h^2) - b(r', rate), r' and what b needs of it:
  VectorLanes constant, r;
  Lane back2, bend1, bend2, rate2;
  Lane most;  // rad/s, see most_turn
  // Eliminated: rate[k] = inverse * right side - before * rate[k-1], and backwards with `after`.
  MatrixLanes inverse, before, after;
  VectorLanes solution, rate;
};

/// rad in the longer interval at a knot. Above about 2.5 rad between knots on irregular stamps the
/// iteration may diverge; this holds the curve, which means little there, within bounds.
constexpr double most_turn = 1000.0;

/// The interval behind the knot: what only the matrices need.
struct NextInterval {
  VectorLanes r;
  Lane h_before, h, rate1, back2;
};

void gather(const RotationIntervals& in, const Pieces& pieces, std::size_t at, Row& row,
            NextInterval& next) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const std::size_t k = pieces.begin[i] + at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row.r[axis][i] = in.vector[axis][k];
      next.r[axis][i] = in.vector[axis][k + 1];
    }
    row.back2[i] = in.back2[k];
    row.bend1[i] = in.bend1[k];
    row.bend2[i] = in.bend2[k];
    row.rate2[i] = in.rate2[k];
    next.h_before[i] = in.length[k];
    next.h[i] = in.length[k + 1];
    next.rate1[i] = in.rate1[k];
    next.back2[i] = in.back2[k + 1];
  }
}

KA_EVERY_PROCESSOR
void eliminate(const NextInterval& next, const MatrixLanes& above, Row& row) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < lanes; ++i) {
    const double before = 1.0 / next.h_before[i], after = 1.0 / next.h[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row.rate[axis][i] = before * row.r[axis][i];  // where the iteration begins
      row.constant[axis][i] =
          6.0 * (before * before * row.r[axis][i] + after * after * next.r[axis][i]);
    }
    row.most[i] = most_turn * std::min(before, after);
    const Matrix left = about(row.r, i, -next.rate1[i], row.rate2[i], 2.0 * before);
    const Matrix right = about(next.r, i, 0.5, next.back2[i], 2.0 * after);
    const Matrix inverse = inverse_of_difference(4.0 * (before + after), left * load(above, i));
    store(inverse, row.inverse, i);
    store(inverse * left, row.before, i);
    store(inverse * right, row.after, i);
  }
}

std::vector<Row> eliminate(const RotationIntervals& intervals, const Pieces& pieces) {
  std::vector<Row> rows(pieces.rows);
  NextInterval next{};
  const MatrixLanes none{};
  for (std::size_t k = 0; k < pieces.rows; ++k) {
    gather(intervals, pieces, k, rows[k], next);
    eliminate(next, k == 0 ? none : rows[k - 1].after, rows[k]);
  }
  return rows;
}

KA_INLINE Vector right_side(const Row& row, std::size_t i) {
  const Vector r = load(row.r, i), w = load(row.rate, i);
  const Vector rw = cross(r, w), rrw = cross(r, rw);
  const double k = row.back2[i];
  // W(r)^-1 w, the derivative of the rotation vector where the interval ends
  const Vector v{w.x + 0.5 * rw.x + k * rrw.x, w.y + 0.5 * rw.y + k * rrw.y,
                 w.z + 0.5 * rw.z + k * rrw.z};
  const Vector c = cross(r, v), rc = cross(r, c), vc = cross(v, c);
  const double along = r.x * v.x + r.y * v.y + r.z * v.z;
  const double b1 = along * row.bend1[i], b2 = along * row.bend2[i], b3 = row.rate2[i];
  return {row.constant[0][i] - b1 * c.x - b2 * rc.x - b3 * vc.x,
          row.constant[1][i] - b1 * c.y - b2 * rc.y - b3 * vc.y,
          row.constant[2][i] - b1 * c.z - b2 * rc.z - b3 * vc.z};
}

KA_EVERY_PROCESSOR
void forwards(std::span<Row> rows, VectorLanes above) {
  for (Row& row : rows) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) {
      const Vector given = load(row.inverse, i) * right_side(row, i);
      const Vector carried = load(row.before, i) * load(above, i);
      const Vector w{given.x - carried.x, given.y - carried.y, given.z - carried.z};
      store(w, row.solution, i);
      store(w, above, i);
    }
  }
}

/// Also takes the solution over as the new rates; returns the largest change of one, as rad in the
/// longer interval at its knot.
KA_EVERY_PROCESSOR
double backwards(std::span<Row> rows, VectorLanes below) {
  Lane change{};
  for (std::size_t k = rows.size(); k-- > 0;) {
    Row& row = rows[k];
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) {
      const Vector carried = load(row.after, i) * load(below, i);
      const Vector w{row.solution[0][i] - carried.x, row.solution[1][i] - carried.y,
                     row.solution[2][i] - carried.z};
      store(w, below, i);
      const double most = row.most[i];
      const Vector kept{std::clamp(w.x, -most, most), std::clamp(w.y, -most, most),
                        std::clamp(w.z, -most, most)};
      const Vector old = load(row.rate, i);
      const double largest = std::max(std::abs(kept.x - old.x),
                                      std::max(std::abs(kept.y - old.y), std::abs(kept.z - old.z)));
      change[i] = std::max(change[i], largest / most);
      store(kept, row.rate, i);
    }
  }
  return most_turn * *std::max_element(change.begin(), change.end());
}

/// The pieces in their state between two sweeps.
struct System {
  Pieces pieces;
  std::vector<Row> rows;
  Vec3 first, last;  // rates at the ends, given

  /// The rate of inner knot k, from the piece where it counts.
  Vec3 rate(std::size_t k) const {
    std::size_t i = 0;
    while (pieces.own[i + 1] <= k) ++i;
    const VectorLanes& rate = rows[k - pieces.begin[i]].rate;
    return {rate[0][i], rate[1][i], rate[2][i]};
  }

  double sweep() {
    VectorLanes above, below;
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::size_t begin = pieces.begin[i], end = begin + pieces.rows;
      const Vec3 left = begin == 0 ? first : rate(begin - 1);
      const Vec3 right = end == pieces.own[lanes] ? last : rate(end);
      store({left.x(), left.y(), left.z()}, above, i);
      store({right.x(), right.y(), right.z()}, below, i);
    }
    forwards(rows, above);
    return backwards(rows, below);
  }
};

constexpr int most_sweeps = 10;       // as many as SciPy's
constexpr double negligible = 1e-13;  // rad of an interval's turn; a seventh of that on the curve

/// Sweeps until what later ones would change, by the rate at which changes shrink, is negligible.
void iterate(System& system) {
  double last_change = 0.0;
  for (int i = 0; i < most_sweeps; ++i) {
    const double change = system.sweep();
    const double shrinks = i == 0 ? 1.0 : change / last_change;
    if (change == 0.0 || (shrinks < 0.5 && change * shrinks / (1.0 - shrinks) < negligible)) break;
    last_change = change;
  }
}

/// Rates at all of a few knots.
std::vector<double> rates_of_window(const RotationKnots& knots) {
  const RotationIntervals intervals(knots);
  const std::size_t n = intervals.size();
  const Vec3 first = intervals.r(0) / intervals.length[0];
  const Vec3 last = intervals.r(n - 1) / intervals.length[n - 1];
  std::vector<double> out(3 * (n + 1));
  vec3(out, 0) = first;
  vec3(out, n) = last;
  if (n == 1) return out;
  const Pieces pieces = cut(n - 1);
  System system{pieces, eliminate(intervals, pieces), first, last};
  iterate(system);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = pieces.own[i]; k < pieces.own[i + 1]; ++k) {
      const VectorLanes& rate = system.rows[k - pieces.begin[i]].rate;
      vec3(out, k + 1) = Vec3(rate[0][i], rate[1][i], rate[2][i]);
    }
  }
  return out;
}

constexpr std::size_t window = 1536;  // knots whose rows, 3 kB of eight, stay in the second cache

}  // namespace

std::vector<double> rotation_spline_rates(const RotationKnots& knots) {
  const std::size_t count = knots.times.size();
  if (count < 2) return std::vector<double>(3 * count, 0.0);
  if (count <= window + 2 * rotation_spline_reach) return rates_of_window(knots);
  std::vector<double> out(3 * count);
  for (std::size_t first = 0; first < count; first += window) {
    const std::size_t begin = first < rotation_spline_reach ? 0 : first - rotation_spline_reach;
    const std::size_t end = std::min(count, first + window + rotation_spline_reach);
    const auto part = rates_of_window({knots.times.subspan(begin, end - begin),
                                       knots.rotations.subspan(4 * begin, 4 * (end - begin))});
    const std::size_t own = std::min(window, count - first);
    std::copy_n(&part[3 * (first - begin)], 3 * own, &out[3 * first]);
  }
  return out;
}

}  // namespace kinalign
