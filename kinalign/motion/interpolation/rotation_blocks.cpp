// SPDX-License-Identifier: Apache-2.0
// Finds the slopes of the spline as SciPy does. Each sweep finds the angular rates by elimination
// in blocks of three numbers; the small term b (rotation_slopes.h) comes from the previous sweep.
// If knots are too far apart, the sweeps do not converge and SciPy's curve is the result of the
// tenth sweep. Only this method gives the same curve for such knots.
#include "kinalign/motion/arrays.h"
#include "kinalign/motion/interpolation/rotation_slopes.h"

#include <algorithm>

namespace kinalign {

namespace {

using Mat3 = Eigen::Matrix3d;

/// W, its inverse and b of rotation_intervals.h, for one interval.
struct Interval {
  double length = 0.0;
  Vec3 r;
  TurnParts parts{};

  Mat3 half_turn() const {
    const Vec3 v = parts.half_r * r;
    return Quat(parts.half_w, v.x(), v.y(), v.z()).toRotationMatrix();
  }
  Mat3 rate_of_slope() const {  // W
    return half_turn().transpose() *
           (parts.across * Mat3::Identity() + parts.along * r * r.transpose());
  }
  Mat3 slope_of_rate() const {  // its inverse
    return half_turn() * (Mat3::Identity() - parts.along * r * r.transpose()) / parts.across;
  }
  Vec3 bend(const Vec3& w) const {
    const double rw = r.dot(w);
    return (parts.square * w.squaredNorm() + parts.product * rw * rw) * r - parts.mixed * rw * w;
  }
};

/// One row of the elimination, for an inner knot: rate = inverse (constant - b) - left * (rate
/// before) - after * (rate after). The rate before is eliminated.
struct Row {
  Mat3 inverse, left, after;
  Vec3 constant, solution;
  double longer = 0.0;  // s, the longer one of the two adjacent intervals
};

struct Blocks {
  std::vector<Interval> intervals;  // [n] between n + 1 knots
  std::vector<Row> rows;            // [n+1]; the first and the last row are not used
  std::vector<Vec3> rates;          // [n+1] angular rate at each knot
};

/// The part of the elimination that does not depend on the rates.
void eliminate(Blocks& s) {
  s.rows.front().after.setZero();
  for (std::size_t k = 1; k < s.intervals.size(); ++k) {
    const Interval &before = s.intervals[k - 1], &behind = s.intervals[k];
    const double b = 1.0 / before.length, a = 1.0 / behind.length;
    Row& row = s.rows[k];
    row.left = 2.0 * b * before.rate_of_slope();
    row.inverse = (4.0 * (b + a) * Mat3::Identity() - row.left * s.rows[k - 1].after).inverse();
    row.left = (row.inverse * row.left).eval();
    row.after = row.inverse * (2.0 * a * behind.slope_of_rate());
    row.constant = 6.0 * (b * b * before.r + a * a * behind.r);
    row.longer = std::max(before.length, behind.length);
  }
}

constexpr double most_turn = 1000.0;

/// One sweep: computes b from the previous rates and solves for all rates. Returns the largest
/// change, rad.
double sweep(Blocks& s) {
  const std::size_t n = s.intervals.size();
  // The rates at both ends are given; only those between are unknown.
  s.rows.front().solution = s.rates.front();
  for (std::size_t k = 1; k < n; ++k) {
    Row& row = s.rows[k];
    row.solution = row.inverse * (row.constant - s.intervals[k - 1].bend(s.rates[k])) -
                   row.left * s.rows[k - 1].solution;
  }
  double change = 0.0;
  Vec3 w = s.rates.back();
  for (std::size_t k = n - 1; k > 0; --k) {
    const Row& row = s.rows[k];
    w = (row.solution - row.after * w).eval();
    // The limit keeps rates finite where the sweeps do not converge.
    const double most = most_turn / row.longer;
    const Vec3 kept = w.cwiseMax(-most).cwiseMin(most);
    change = std::max(change, (kept - s.rates[k]).cwiseAbs().maxCoeff() * row.longer);
    s.rates[k] = kept;
  }
  return change;
}

constexpr int most_sweeps = 10;       // the limit of SciPy
constexpr double negligible = 1e-13;  // rad in one interval; the curve changes by a seventh of this

/// Sweeps until the further change is negligible. This change is estimated from how fast the
/// changes shrink.
void iterate(Blocks& s) {
  double last = 0.0;
  for (int i = 0; i < most_sweeps; ++i) {
    const double change = sweep(s);
    const double shrinks = i == 0 ? 1.0 : change / last;
    if (change == 0.0 || (shrinks < 0.5 && change * shrinks / (1.0 - shrinks) < negligible)) break;
    last = change;
  }
}

}  // namespace

void slopes_by_blocks(const RotationIntervals& in, RotationSlopes& to) {
  const std::size_t n = in.size();
  Blocks s{std::vector<Interval>(n), std::vector<Row>(n + 1), std::vector<Vec3>(n + 1)};
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 r(in.vector[0][k], in.vector[1][k], in.vector[2][k]);
    s.intervals[k] = {in.length[k], r, turn_parts(r.squaredNorm())};
    // The iteration starts from the mean rate of each interval.
    s.rates[k + 1] = r / in.length[k];
  }
  s.rates.front() = s.rates[1];
  eliminate(s);
  iterate(s);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 end = s.intervals[k].slope_of_rate() * s.rates[k + 1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      to.begin[axis][k] = s.rates[k][a];
      to.end[axis][k] = end[a];
    }
  }
}

}  // namespace kinalign
