// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/rotation_intervals.h"

#include "kinalign/motion/rotation.h"
#include "kinalign/motion/targets.h"

namespace kinalign {

namespace {

KA_EVERY_PROCESSOR
void measure_vectors(const double* q, std::size_t n, double* rx, double* ry, double* rz) {
  for (std::size_t i = 0; i < n; ++i, q += 4) {
    // conjugate(left) * right
    // Quaternions are multiplied without Eigen here, because the loop must become vector code.
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

}  // namespace

void measure_intervals(const RotationKnots& knots, RotationIntervals& to) {
  const std::size_t n = knots.times.size() - 1;
  to.length.resize(n);
  for (auto& column : to.vector) column.resize(n);
  for (std::size_t i = 0; i < n; ++i) to.length[i] = knots.times[i + 1] - knots.times[i];
  measure_vectors(knots.rotations.data(), n, to.vector[0].data(), to.vector[1].data(),
                  to.vector[2].data());
}

}  // namespace kinalign
