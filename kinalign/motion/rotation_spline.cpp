// SPDX-License-Identifier: Apache-2.0
// The rates at the knots. Symbols as in "Smooth Attitude Interpolation" (see the header), for the
// interval from knot k to k + 1: r its rotation vector, h its length; W(r) turns the derivative of
// a rotation vector into an angular rate, W(r)^-1 back. Continuous angular acceleration at knot k
// demands
//   2/h' W(r') w[k-1] + 4 (1/h' + 1/h) w[k] + 2/h W(r)^-1 w[k+1] = 6 (r'/h'^2 + r/h^2) - b(r',
//   w[k])
// with ' for the interval before; b is quadratic in the rate and is iterated.
#include "kinalign/motion/rotation_spline.h"

#include "kinalign/motion/rotation_intervals.h"
#include "kinalign/motion/targets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinalign {

namespace {

using Matrix = Eigen::Matrix3d;

/// first * r x . + second * r x (r x .) + 1, as a matrix.
Matrix about(const Vec3& r, double first, double second) {
  const double x = r.x(), y = r.y(), z = r.z();
  const double xx = second * x * x, yy = second * y * y, zz = second * z * z;
  const double xy = second * x * y, xz = second * x * z, yz = second * y * z;
  const double fx = first * x, fy = first * y, fz = first * z;
  Matrix m;
  m << 1.0 - yy - zz, xy - fz, xz + fy,  //
      xy + fz, 1.0 - xx - zz, yz - fx,   //
      xz - fy, yz + fx, 1.0 - xx - yy;
  return m;
}

/// The block tridiagonal system for the rates at the inner knots, eliminated once:
/// rate[k] = inverse * right side - before * rate[k-1], and so backwards with `after`.
struct Step {
  Matrix inverse, before, after;
};

std::vector<Step> eliminate(const RotationIntervals& intervals) {
  const std::size_t inner = intervals.size() - 1;
  std::vector<Step> steps(inner);
  Matrix after = Matrix::Zero();
  for (std::size_t k = 0; k < inner; ++k) {
    const double to_left = 2.0 / intervals.length[k], to_right = 2.0 / intervals.length[k + 1];
    const Matrix left = to_left * about(intervals.r(k), -intervals.rate1[k], intervals.rate2[k]);
    const Matrix right = to_right * about(intervals.r(k + 1), 0.5, intervals.back2[k + 1]);
    const Matrix pivot = 2.0 * (to_left + to_right) * Matrix::Identity() - left * after;
    Step& step = steps[k];
    step.inverse = pivot.inverse();
    step.before = step.inverse * left;
    after = step.inverse * right;
    step.after = after;
  }
  return steps;
}

/// Right side of the system at the inner knots, [n-1] x, y, z one after the other in `out`.
KA_EVERY_PROCESSOR
void right_side(const RotationIntervals& in, std::size_t inner, const Columns& rates, double* out) {
  const double *x = in.vector[0].data(), *y = in.vector[1].data(), *z = in.vector[2].data();
  const double *wx = rates[0].data(), *wy = rates[1].data(), *wz = rates[2].data();
  const double *h = in.length.data(), *back2 = in.back2.data(), *rate2 = in.rate2.data();
  const double *bend1 = in.bend1.data(), *bend2 = in.bend2.data();
#pragma GCC ivdep
  for (std::size_t k = 0; k < inner; ++k) {
    const double rx = x[k], ry = y[k], rz = z[k], ux = wx[k], uy = wy[k], uz = wz[k];
    const double cx = ry * uz - rz * uy, cy = rz * ux - rx * uz, cz = rx * uy - ry * ux;
    const double ccx = ry * cz - rz * cy, ccy = rz * cx - rx * cz, ccz = rx * cy - ry * cx;
    // v = W(r)^-1 w, the rotation vector's derivative at the interval's end
    const double vx = ux + 0.5 * cx + back2[k] * ccx, vy = uy + 0.5 * cy + back2[k] * ccy,
                 vz = uz + 0.5 * cz + back2[k] * ccz;
    const double dx = ry * vz - rz * vy, dy = rz * vx - rx * vz, dz = rx * vy - ry * vx;
    const double ex = ry * dz - rz * dy, ey = rz * dx - rx * dz, ez = rx * dy - ry * dx;
    const double gx = vy * dz - vz * dy, gy = vz * dx - vx * dz, gz = vx * dy - vy * dx;
    const double along = rx * vx + ry * vy + rz * vz;
    const double before = 6.0 / (h[k] * h[k]), after = 6.0 / (h[k + 1] * h[k + 1]);
    out[3 * k] =
        before * rx + after * x[k + 1] - along * (bend1[k] * dx + bend2[k] * ex) - rate2[k] * gx;
    out[3 * k + 1] =
        before * ry + after * y[k + 1] - along * (bend1[k] * dy + bend2[k] * ey) - rate2[k] * gy;
    out[3 * k + 2] =
        before * rz + after * z[k + 1] - along * (bend1[k] * dz + bend2[k] * ez) - rate2[k] * gz;
  }
}

/// Rates at the right ends of the intervals, as the iteration sees them.
struct Rates {
  Vec3 first, last;  // at the ends, given
  Columns inner;     // [n-1]
};

/// rad in the shorter interval at a knot. Above about 2.5 rad between knots on irregular stamps
/// the iteration may diverge; this holds the curve, which means little there, within bounds.
constexpr double most_turn = 30.0;

/// One solution of the system; returns the largest change of a rate times its shorter interval,
/// rad.
double sweep(const RotationIntervals& intervals, const std::vector<Step>& steps,
             std::vector<double>& right, Rates& rates) {
  const std::size_t inner = steps.size();
  Vec3 w = rates.first;
  for (std::size_t k = 0; k < inner; ++k) {
    Eigen::Map<Vec3> at(&right[3 * k]);
    w = steps[k].inverse * at - steps[k].before * w;
    at = w;
  }
  double change = 0.0;
  w = rates.last;
  for (std::size_t k = inner; k-- > 0;) {
    w = Eigen::Map<const Vec3>(&right[3 * k]) - steps[k].after * w;
    const double h = std::min(intervals.length[k], intervals.length[k + 1]);
    for (Eigen::Index i = 0; i < 3; ++i) {
      double& rate = rates.inner[static_cast<std::size_t>(i)][k];
      const double kept = std::clamp(w[i], -most_turn / h, most_turn / h);
      change = std::max(change, h * std::abs(kept - rate));
      rate = kept;
    }
  }
  return change;
}

constexpr int most_sweeps = 10;       // as many as SciPy's
constexpr double negligible = 2e-13;  // rad of an interval's turn; a seventh of that on the curve

/// Sweeps until what later ones would change, by the rate at which changes shrink, is negligible.
void iterate(const RotationIntervals& intervals, const std::vector<Step>& steps, Rates& rates) {
  std::vector<double> right(3 * steps.size());
  double last_change = 0.0;
  for (int i = 0; i < most_sweeps; ++i) {
    right_side(intervals, steps.size(), rates.inner, right.data());
    const double change = sweep(intervals, steps, right, rates);
    const double shrinks = i == 0 ? 1.0 : change / last_change;
    if (change == 0.0 || (shrinks < 0.5 && change * shrinks / (1.0 - shrinks) < negligible)) break;
    last_change = change;
  }
}

}  // namespace

std::vector<double> rotation_spline_rates(const RotationKnots& knots) {
  const std::size_t count = knots.times.size();
  std::vector<double> out(3 * count, 0.0);
  if (count < 2) return out;
  const RotationIntervals intervals(knots);
  const std::size_t n = count - 1;
  Rates rates{
      intervals.r(0) / intervals.length[0], intervals.r(n - 1) / intervals.length[n - 1], {}};
  for (std::size_t i = 0; i < 3; ++i) {
    rates.inner[i].resize(n - 1);
    for (std::size_t k = 0; k + 1 < n; ++k) {
      rates.inner[i][k] = intervals.vector[i][k] / intervals.length[k];
    }
  }
  if (n > 1) iterate(intervals, eliminate(intervals), rates);
  vec3(out, 0) = rates.first;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    for (std::size_t i = 0; i < 3; ++i) out[3 * (k + 1) + i] = rates.inner[i][k];
  }
  vec3(out, n) = rates.last;
  return out;
}

}  // namespace kinalign
