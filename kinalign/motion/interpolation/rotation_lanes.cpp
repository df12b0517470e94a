// SPDX-License-Identifier: Apache-2.0
// Finds the slopes for many knots that are close to each other. Two ideas make this fast.
//
// First, W(r) = H^-1 D is nearly a rotation by half of r. Rates are therefore expressed in spaces
// that follow the knots at half their rotation: z[k] = H(r[0]) ... H(r[k-1]) w[k]. The vectors r
// are expressed in the same spaces. In the system of rotation_slopes.h this replaces W by D and w
// by z. The terms with D - 1, D^-1 - 1 and b are all of the order of
// |r|^2 / 24. They are moved to the right side and found by iteration. The left side is then the
// same tridiagonal system of scalars for x, y and z. With knots 0.3 rad apart, each sweep reduces
// the error to 1/300.
//
// Second, the rows of such a system depend on each other in sequence. The knots are therefore cut
// into eight pieces, which vector code sweeps in parallel. A piece starts from the result of its
// neighbour in the previous sweep. The correct start is known at the end of the sweep, and the
// effect of the difference fades within a few rows.
#include "kinalign/motion/interpolation/rotation_slopes.h"
#include "kinalign/motion/interpolation/vector_lanes.h"
#include "kinalign/motion/targets.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

namespace kinalign {

namespace {

/// One knot of each of the eight pieces, and the interval before it.
struct alignas(64) Row {
  VectorLanes r;
  Lane length, per_second;      // s; 1/s
  Lane square, product, mixed;  // factors of b
  // Left: 2/h (1 - D) v = left v - left_r (r . v) r; right: 2/h (D^-1 - 1).
  Lane left, left_r, right, right_r;
  Lane along, widen;           // D^-1 v = widen (v - along (r . v) r)
  QuaternionLanes turn;        // H ... H: from the space of the knot to the space of its piece
  Lane scale, before, after;   // z = scale * right side - before z[k-1] - after z[k+1]
  VectorLanes constant;        // constant part of the right side
  VectorLanes solution, rate;  // z before and after the backward substitution
};

/// Rows [1, size - 1) of each piece are unknowns. The first and the last row belong to its
/// neighbours or are given.
struct Pieces {
  std::size_t stride = 0;  // knots from one piece's first row to the next one's
  std::size_t size = 0;
  std::unique_ptr<Row[]> rows;

  Row& first() const { return rows[0]; }
  Row& last() const { return rows[size - 1]; }
};

// A change beyond the end of a piece fades to at most 2^-32 within this number of rows.
constexpr std::size_t seam = 32;

void gather(const RotationIntervals& in, const Pieces& to) {
  for (std::size_t j = 1; j < to.size; ++j) {
    Row& row = to.rows[j];
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::size_t k = i * to.stride + j - 1;
      row.length[i] = in.length[k];
      for (std::size_t axis = 0; axis < 3; ++axis) row.r[axis][i] = in.vector[axis][k];
    }
    row.rate = {};
  }
}

/// Computes, for lane i, all factors of an interval's row that do not change from sweep to sweep.
KA_INLINE void measure(const Row& before, Row& row, std::size_t i) {
  const Quaternion turn = load(before.turn, i);
  const Vector r = load(row.r, i);
  const double x = dot(r, r);
  const TurnParts parts = turn_parts(x);
  store(turned(turn, r), row.r, i);
  store(turn * Quaternion{parts.half_w, parts.half_r * r}, row.turn, i);
  row.per_second[i] = 1.0 / row.length[i];
  row.square[i] = parts.square;
  row.product[i] = parts.product;
  row.mixed[i] = parts.mixed;
  row.along[i] = parts.along;
  row.widen[i] = 1.0 / parts.across;
  row.left_r[i] = 2.0 * row.per_second[i] * parts.along;
  row.left[i] = row.left_r[i] * x;
  row.right_r[i] = row.left_r[i] * row.widen[i];
  row.right[i] = row.right_r[i] * x;
}

KA_INLINE void eliminate(const Row& before, Row& row, const Row& after, std::size_t i) {
  const double h = row.length[i], next = after.length[i];
  const double b = row.per_second[i], a = after.per_second[i];
  const double scale = 1.0 / (2.0 * (h + next) - next * before.after[i]);
  row.scale[i] = 0.5 * scale * h * next;
  row.before[i] = scale * next;
  row.after[i] = scale * h;
  const Vector constant = (6.0 * b * b) * load(row.r, i) + (6.0 * a * a) * load(after.r, i);
  store(constant, row.constant, i);
  store(row.scale[i] * constant - row.before[i] * load(before.solution, i), row.solution, i);
}

/// Computes the factors of all rows. Also solves forwards with D = 1 and b = 0, which is the start
/// of the iteration.
KA_EVERY_PROCESSOR
void set_up(std::span<Row> rows) {
  for (std::size_t j = 1; j < rows.size(); ++j) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) measure(rows[j - 1], rows[j], i);
    if (j == 1) continue;
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) eliminate(rows[j - 2], rows[j - 1], rows[j], i);
  }
}

/// Computes `after` in the first row of each piece from a few rows at the end of the previous
/// piece.
KA_EVERY_PROCESSOR
void begin_elimination(const Pieces& s) {
  Lane after{};
  for (std::size_t j = s.stride - seam; j <= s.stride; ++j) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const double h = s.rows[j].length[i], next = s.rows[j + 1].length[i];
      after[i] = h / (2.0 * (h + next) - next * after[i]);
    }
  }
  s.first().after[0] = 0.0;
  std::copy_n(after.begin(), lanes - 1, s.first().after.begin() + 1);
}

/// Cuts the intervals into pieces and solves the linear part.
Pieces cut(const RotationIntervals& in) {
  Pieces s;
  const std::size_t unknown = in.size() - 1;
  s.stride = unknown / lanes;
  s.size = unknown - (lanes - 1) * s.stride + 2;
  s.rows = std::make_unique_for_overwrite<Row[]>(s.size);
  Row &first = s.first(), &last = s.last();
  first = {};
  first.turn[0].fill(1.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first.solution[axis][0] = first.rate[axis][0] = in.vector[axis][0] / in.length[0];
  }
  gather(in, s);
  begin_elimination(s);
  set_up({&first, s.size});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    last.rate[axis].back() = last.r[axis].back() * last.per_second.back();
  }
  return s;
}

/// The forward half of the elimination: each row's solution follows from the rows before it.
KA_EVERY_PROCESSOR
void forwards(std::span<Row> rows) {
  for (std::size_t j = 1; j + 1 < rows.size(); ++j) {
    const Row &before = rows[j - 1], &after = rows[j + 1];
    Row& row = rows[j];
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) {
      const Vector z = load(row.rate, i), left = load(before.rate, i), right = load(after.rate, i);
      const Vector r = load(row.r, i), next = load(after.r, i);
      const double rz = dot(r, z);
      const double on_r =
          row.left_r[i] * dot(r, left) + row.square[i] * dot(z, z) + row.product[i] * rz * rz;
      const double on_next = after.right_r[i] * dot(next, right);
      const Vector side = load(row.constant, i) + row.left[i] * left + (row.mixed[i] * rz) * z -
                          after.right[i] * right - on_r * r + on_next * next;
      store(row.scale[i] * side - row.before[i] * load(before.solution, i), row.solution, i);
    }
  }
}

/// Substitutes backwards. Returns the largest change of a rate, rad in the longer interval at its
/// knot.
KA_EVERY_PROCESSOR
double backwards(std::span<Row> rows) {
  Lane change{};
  for (std::size_t j = rows.size() - 2; j > 0; --j) {
    const Row& after = rows[j + 1];
    Row& row = rows[j];
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) {
      const Vector z = load(row.solution, i) - row.after[i] * load(after.rate, i);
      const Vector d = z - load(row.rate, i);
      const double largest = std::max(std::abs(d.x), std::max(std::abs(d.y), std::abs(d.z)));
      change[i] = std::max(change[i], largest * std::max(row.length[i], after.length[i]));
      store(z, row.rate, i);
    }
  }
  return *std::max_element(change.begin(), change.end());
}

/// Copies a value into an outer row of each piece: the value that its neighbour found for the same
/// knot in row `from`. `step` 1: the neighbour is one lane before; -1: one lane after. Returns the
/// changes.
VectorLanes take_over(const Row& from, Row& to, VectorLanes Row::*what, std::ptrdiff_t step) {
  VectorLanes change{};
  const std::size_t source = step > 0 ? 0 : 1, target = 1 - source;
  for (std::size_t i = 0; i + 1 < lanes; ++i) {
    const Vector w = turned(conjugate(load(from.turn, i + source)), load(from.*what, i + source));
    const Vector z = turned(load(to.turn, i + target), w);
    store(z - load(to.*what, i + target), change, i + target);
    store(z, to.*what, i + target);
  }
  return change;
}

/// Propagates a change in an outer row of a piece to the next rows of the piece.
KA_EVERY_PROCESSOR
void mend(Row* row, std::ptrdiff_t step, VectorLanes change, Lane Row::*weight,
          VectorLanes Row::*what) {
  for (std::size_t n = 0; n < seam; ++n) {
    row += step;
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) {
      const Vector felt = -(row->*weight)[i] * load(change, i);
      store(felt, change, i);
      store(load(row->*what, i) + felt, row->*what, i);
    }
  }
}

/// Computes new rates from the forward solution; returns their largest change.
double take_back(const Pieces& s) {
  Row &first = s.first(), &last = s.last();
  const Row &before_first = s.rows[s.stride], &behind_last = s.rows[s.size - 1 - s.stride];
  mend(&first, 1, take_over(before_first, first, &Row::solution, 1), &Row::before, &Row::solution);
  const double change = backwards({&first, s.size});
  mend(&last, -1, take_over(behind_last, last, &Row::rate, -1), &Row::after, &Row::rate);
  take_over(before_first, first, &Row::rate, 1);
  return change;
}

/// Writes the slopes at both ends of each interval in the axes of the interval's begin.
KA_EVERY_PROCESSOR
void hand_out(const Pieces& s, RotationSlopes& to) {
  for (std::size_t j = 1; j < s.size; ++j) {
    const Row &before = s.rows[j - 1], &row = s.rows[j];
    VectorLanes begin, end;
#pragma GCC ivdep
    for (std::size_t i = 0; i < lanes; ++i) {
      const Quaternion back = conjugate(load(before.turn, i));
      const Vector z = load(row.rate, i), r = load(row.r, i);
      store(turned(back, load(before.rate, i)), begin, i);
      store(turned(back, row.widen[i] * (z - (row.along[i] * dot(r, z)) * r)), end, i);
    }
    for (std::size_t i = 0; i < lanes; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to.begin[axis][i * s.stride + j - 1] = begin[axis][i];
        to.end[axis][i * s.stride + j - 1] = end[axis][i];
      }
    }
  }
}

constexpr double negligible = 1e-13;  // rad in one interval; the curve changes by a seventh of that
// If this many sweeps are not enough, more sweeps rarely help, and the estimate of the change gets
// worse.
constexpr int most_sweeps = 8;

/// Sweeps until the further change is negligible. This change is estimated from how fast the
/// changes shrink.
/// Returns false if the changes do not shrink fast.
bool settle(const Pieces& s) {
  double last = take_back(s);
  for (int i = 0; i < most_sweeps && last > negligible; ++i) {
    forwards({s.rows.get(), s.size});
    const double change = take_back(s), shrinks = change / last;
    if (!(shrinks < 0.5)) return false;
    if (change * shrinks / (1.0 - shrinks) < negligible) return true;
    last = change;
  }
  return last <= negligible;
}

}  // namespace

bool slopes_in_lanes(const RotationIntervals& intervals, RotationSlopes& to) {
  if (intervals.size() <= (seam + 1) * lanes) return false;
  const Pieces pieces = cut(intervals);
  if (!settle(pieces)) return false;
  hand_out(pieces, to);
  return true;
}

}  // namespace kinalign
