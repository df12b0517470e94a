// SPDX-License-Identifier: Apache-2.0
// The rotation spline between its knots, 64 samples at a time.
#include "kinalign/motion/rotation.h"
#include "kinalign/motion/rotation_intervals.h"
#include "kinalign/motion/rotation_spline.h"
#include "kinalign/motion/targets.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

/// The rotation vector from an interval's left knot, of the fraction u of the interval that has
/// passed: u (one + u (two + u three)).
struct Cubic {
  Vec3 one, two, three;
};

std::vector<Cubic> cubics(const RotationIntervals& intervals, std::span<const double> rates) {
  std::vector<Cubic> out(intervals.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Vec3 r = intervals.r(k), end = vec3(rates, k + 1);
    const Vec3 cross = r.cross(end);
    const Vec3 begins = intervals.length[k] * vec3(rates, k);
    const Vec3 ends =
        intervals.length[k] * (end + 0.5 * cross + intervals.back2[k] * r.cross(cross));
    out[k] = {begins, 3.0 * r - 2.0 * begins - ends, begins + ends - 2.0 * r};
  }
  return out;
}

constexpr std::size_t block = 64;
using Lane = std::array<double, block>;

struct Samples {
  Lane fraction;
  std::array<Lane, 9> cubic;
  std::array<Lane, 4> knot;
  std::array<Lane, 4> rotation;
  Lane square;  // of the rotation vector from the knot
};

void load(Samples& s, std::size_t i, const Cubic& cubic, const double* knot) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    s.cubic[k][i] = cubic.one[axis];
    s.cubic[3 + k][i] = cubic.two[axis];
    s.cubic[6 + k][i] = cubic.three[axis];
  }
  for (std::size_t k = 0; k < 4; ++k) s.knot[k][i] = knot[k];
}

KA_EVERY_PROCESSOR
void turn(Samples& s) {
  for (std::size_t i = 0; i < block; ++i) {
    const double u = s.fraction[i];
    const double rx = u * (s.cubic[0][i] + u * (s.cubic[3][i] + u * s.cubic[6][i]));
    const double ry = u * (s.cubic[1][i] + u * (s.cubic[4][i] + u * s.cubic[7][i]));
    const double rz = u * (s.cubic[2][i] + u * (s.cubic[5][i] + u * s.cubic[8][i]));
    s.square[i] = rx * rx + ry * ry + rz * rz;
    const RotationParts parts = rotation_parts(s.square[i]);
    const double x = parts.vector * rx, y = parts.vector * ry, z = parts.vector * rz;
    const double kw = s.knot[0][i], kx = s.knot[1][i], ky = s.knot[2][i], kz = s.knot[3][i];
    s.rotation[0][i] = kw * parts.w - kx * x - ky * y - kz * z;
    s.rotation[1][i] = kw * x + kx * parts.w + ky * z - kz * y;
    s.rotation[2][i] = kw * y - kx * z + ky * parts.w + kz * x;
    s.rotation[3][i] = kw * z + kx * y - ky * x + kz * parts.w;
  }
}

void store(const Samples& s, std::size_t count, double* out) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!(s.square[i] <= most_rotation_parts)) {  // rare: more than a whole turn between two knots
      const double u = s.fraction[i];
      Vec3 r;
      for (std::size_t k = 0; k < 3; ++k) {
        r[static_cast<Eigen::Index>(k)] =
            u * (s.cubic[k][i] + u * (s.cubic[3 + k][i] + u * s.cubic[6 + k][i]));
      }
      const Quat knot(s.knot[0][i], s.knot[1][i], s.knot[2][i], s.knot[3][i]);
      put_quat({out + 4 * i, 4}, 0, knot * rotation(r));
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) out[4 * i + k] = s.rotation[k][i];
  }
}

void fill(const RotationKnots& knots, std::span<const double> rates, std::span<const double> at,
          double* out) {
  const auto& t = knots.times;
  const std::vector<Cubic> curve = cubics(RotationIntervals(knots), rates);
  Samples samples{};
  std::size_t k = 0;
  for (std::size_t first = 0; first < at.size(); first += block) {
    const std::size_t count = std::min(block, at.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      while (k + 2 < t.size() && at[first + i] >= t[k + 1]) ++k;
      samples.fraction[i] = (at[first + i] - t[k]) / (t[k + 1] - t[k]);
      load(samples, i, curve[k], &knots.rotations[4 * k]);
    }
    turn(samples);
    store(samples, count, out + 4 * first);
  }
}

constexpr std::size_t window = 1024;  // intervals at a time: little memory, which stays in cache

}  // namespace

void rotation_spline_at(const RotationKnots& knots, std::span<const double> rates,
                        std::span<const double> at, std::span<double> out) {
  const auto& t = knots.times;
  if (t.size() == 1) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      std::copy_n(knots.rotations.begin(), 4, &out[4 * i]);
    }
    return;
  }
  std::size_t sample = 0;
  for (std::size_t first = 0; first + 1 < t.size() && sample < at.size(); first += window) {
    const std::size_t count = std::min(window + 1, t.size() - first);
    const bool last = first + count == t.size();
    std::size_t end = at.size();
    if (!last) {
      const auto behind = std::lower_bound(at.begin(), at.end(), t[first + count - 1]);
      end = static_cast<std::size_t>(behind - at.begin());
    }
    fill({t.subspan(first, count), knots.rotations.subspan(4 * first, 4 * count)},
         rates.subspan(3 * first, 3 * count), at.subspan(sample, end - sample), &out[4 * sample]);
    sample = end;
  }
}

}  // namespace kinalign
