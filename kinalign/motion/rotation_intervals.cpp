// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/rotation_intervals.h"

#include "kinalign/motion/rotation.h"
#include "kinalign/motion/targets.h"

namespace kinalign {

namespace {

/// From series in the squared angle x that hold up to pi without cancellation; b1 and b2 are cosine
/// and sine behind their first two terms.
struct Coefficients {
  double rate1, rate2, back2, bend1, bend2;
};

KA_INLINE Coefficients coefficients(double x) {
  constexpr auto cosine_rest = alternating_series<14>(4);
  constexpr auto sine_rest = alternating_series<13>(5);
  const double b1 = polynomial(cosine_rest, x), b2 = polynomial(sine_rest, x);
  const double rate1 = 0.5 - x * b1, rate2 = 1.0 / 6.0 - x * b2, bend1 = rate2 - 2.0 * b1;
  return {rate1, rate2, bend1 / (2.0 * rate1), bend1, 3.0 * b2 - b1};
}

KA_EVERY_PROCESSOR
void measure_vectors(const double* q, std::size_t n, double* rx, double* ry, double* rz) {
  for (std::size_t i = 0; i < n; ++i, q += 4) {
    // conjugate(left) * right
    const double w = q[0] * q[4] + q[1] * q[5] + q[2] * q[6] + q[3] * q[7];
    const double x = q[0] * q[5] - q[1] * q[4] - q[2] * q[7] + q[3] * q[6];
    const double y = q[0] * q[6] + q[1] * q[7] - q[2] * q[4] - q[3] * q[5];
    const double z = q[0] * q[7] - q[1] * q[6] + q[2] * q[5] - q[3] * q[4];
    const double factor = rotation_vector_factor(w, x * x + y * y + z * z);
    rx[i] = factor * x;
    ry[i] = factor * y;
    rz[i] = factor * z;
  }
}

KA_EVERY_PROCESSOR
void measure_coefficients(RotationIntervals& to, std::size_t n) {
  const double *rx = to.vector[0].data(), *ry = to.vector[1].data(), *rz = to.vector[2].data();
  double *rate1 = to.rate1.data(), *rate2 = to.rate2.data(), *back2 = to.back2.data();
  double *bend1 = to.bend1.data(), *bend2 = to.bend2.data();
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const Coefficients c = coefficients(rx[i] * rx[i] + ry[i] * ry[i] + rz[i] * rz[i]);
    rate1[i] = c.rate1;
    rate2[i] = c.rate2;
    back2[i] = c.back2;
    bend1[i] = c.bend1;
    bend2[i] = c.bend2;
  }
}

}  // namespace

RotationIntervals::RotationIntervals(const RotationKnots& knots)
    : length(knots.times.size() - 1),
      rate1(length.size()),
      rate2(length.size()),
      back2(length.size()),
      bend1(length.size()),
      bend2(length.size()) {
  for (auto& column : vector) column.resize(size());
  for (std::size_t i = 0; i < size(); ++i) length[i] = knots.times[i + 1] - knots.times[i];
  measure_vectors(knots.rotations.data(), size(), vector[0].data(), vector[1].data(),
                  vector[2].data());
  measure_coefficients(*this, size());
}

}  // namespace kinalign
