// SPDX-License-Identifier: Apache-2.0
// Processes 64 samples at a time. Vector code computes the four numbers of one sample together, and
// the polynomials of angles for eight samples together.
#include "kinalign/motion/interpolation/rotation_curve.h"

#include "kinalign/motion/interpolation/vector_lanes.h"
#include "kinalign/motion/rotation.h"
#include "kinalign/motion/targets.h"

#include <algorithm>
#include <array>
#include <memory>

namespace kinalign {

namespace {

using Four = std::array<double, 4>;

/// The curve in each interval. At the fraction u of the interval, the rotation vector from the left
/// knot is c = u (c1 + u (c2 + u c3)) and the rotation is
///   knot (cos(|c|/2) + sin(|c|/2)/|c| c) = cos(|c|/2) knot + sin(|c|/2)/|c| (knot c),
/// where all products are quaternion products. This structure stores knot c1, knot c2 and knot c3,
/// so a sample needs no quaternion product, and |knot c| = |c|.
struct Cubics {
  explicit Cubics(std::size_t n)
      : one(std::make_unique_for_overwrite<Four[]>(n)),
        two(std::make_unique_for_overwrite<Four[]>(n)),
        three(std::make_unique_for_overwrite<Four[]>(n)) {}

  std::unique_ptr<Four[]> one, two, three;  // [n] for each interval: knot c1, knot c2, knot c3
};

KA_INLINE void multiply(const double* q, const Vector& v, Four& to) {
  to[0] = -q[1] * v.x - q[2] * v.y - q[3] * v.z;
  to[1] = q[0] * v.x + q[2] * v.z - q[3] * v.y;
  to[2] = q[0] * v.y + q[3] * v.x - q[1] * v.z;
  to[3] = q[0] * v.z + q[1] * v.y - q[2] * v.x;
}

struct ColumnView {
  const double *x, *y, *z;

  explicit ColumnView(const Columns& c) : x(c[0].data()), y(c[1].data()), z(c[2].data()) {}
  KA_INLINE Vector operator[](std::size_t k) const { return {x[k], y[k], z[k]}; }
};

KA_EVERY_PROCESSOR
void multiply(const RotationCurve& curve, const Cubics& to) {
  const std::size_t n = curve.intervals.size();
  const double *q = curve.knots.rotations.data(), *length = curve.intervals.length.data();
  const ColumnView vector(curve.intervals.vector);
  const ColumnView begin(curve.slopes.begin), end(curve.slopes.end);
  // ivdep: the outputs do not overlap the inputs.
  Four *one = to.one.get(), *two = to.two.get(), *three = to.three.get();
#pragma GCC ivdep
  for (std::size_t k = 0; k < n; ++k) {
    const Vector r = vector[k], begins = length[k] * begin[k], ends = length[k] * end[k];
    multiply(q + 4 * k, begins, one[k]);
    multiply(q + 4 * k, 3.0 * r - 2.0 * begins - ends, two[k]);
    multiply(q + 4 * k, begins + ends - 2.0 * r, three[k]);
  }
}

constexpr std::size_t block = 64;

struct alignas(64) Samples {
  std::array<std::size_t, block> interval;
  std::array<double, block> fraction;
  std::array<Four, block> vector;    // knot c / u
  std::array<double, block> square;  // |c|^2
  std::array<double, block> knot_weight, vector_weight;
};

KA_EVERY_PROCESSOR
void place(const Cubics& curve, Samples& s) {
  for (std::size_t i = 0; i < block; ++i) {
    const std::size_t n = s.interval[i];
    const Four &one = curve.one[n], &two = curve.two[n], &three = curve.three[n];
    const double u = s.fraction[i];
    Four v;
    for (std::size_t k = 0; k < 4; ++k) v[k] = one[k] + u * (two[k] + u * three[k]);
    s.vector[i] = v;
    s.square[i] = u * u * ((v[0] * v[0] + v[2] * v[2]) + (v[1] * v[1] + v[3] * v[3]));
  }
}

KA_EVERY_PROCESSOR
void weigh(Samples& s) {
  for (std::size_t i = 0; i < block; ++i) {
    const RotationParts parts = rotation_parts(s.square[i]);
    s.knot_weight[i] = parts.w;
    s.vector_weight[i] = s.fraction[i] * parts.vector;
  }
}

KA_EVERY_PROCESSOR
void blend(const Samples& s, std::size_t count, const double* knots, double* out) {
  for (std::size_t i = 0; i < count; ++i, out += 4) {
    const double* knot = knots + 4 * s.interval[i];
#pragma GCC ivdep
    for (std::size_t k = 0; k < 4; ++k) {
      out[k] = s.knot_weight[i] * knot[k] + s.vector_weight[i] * s.vector[i][k];
    }
  }
}

/// Handles samples that are more than a whole turn from the left knot, where weigh() is not valid.
/// Such samples are rare.
void turn_far(const Samples& s, std::size_t count, std::span<const double> knots, double* out) {
  for (std::size_t i = 0; i < count; ++i) {
    if (s.square[i] <= most_rotation_parts) continue;
    // The stored vector is the product knot c. The product with the conjugate of the knot gives c
    // again.
    const Quat knot = quat(knots, s.interval[i]), vector = quat(s.vector[i], 0);
    const Vec3 c = s.fraction[i] * (knot.conjugate() * vector).vec();
    put_quat({out + 4 * i, 4}, 0, knot * rotation(c));
  }
}

}  // namespace

void rotation_curve_at(const RotationCurve& curve, std::span<const double> at,
                       std::span<double> out) {
  const auto& t = curve.knots.times;
  const Cubics in(curve.intervals.size());
  multiply(curve, in);
  Samples samples{};
  std::size_t k = 0;
  for (std::size_t first = 0; first < at.size(); first += block) {
    const std::size_t count = std::min(block, at.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      // The last knot belongs to the last interval.
      while (k + 2 < t.size() && at[first + i] >= t[k + 1]) ++k;
      samples.interval[i] = k;
      samples.fraction[i] = (at[first + i] - t[k]) / (t[k + 1] - t[k]);
    }
    place(in, samples);
    weigh(samples);
    blend(samples, count, curve.knots.rotations.data(), &out[4 * first]);
    turn_far(samples, count, curve.knots.rotations, &out[4 * first]);
  }
}

}  // namespace kinalign
