// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/rotation_rows.h"

#include "kinalign/motion/interpolation/rotation_spline.h"
#include "kinalign/motion/interpolation/slerp.h"

namespace kinalign {

std::vector<double> rotations_at(RotationCurve curve, std::span<const double> times,
                                 std::span<const double> knots, std::span<const double> at) {
  std::vector<double> out(4 * at.size());
  // With slerp the angular velocity is constant between knots and jumps at knots. With the spline
  // it is continuous.
  if (curve == RotationCurve::slerp) {
    slerp_at(times, knots, at, out);
  } else {
    const RotationKnots rotations{times, knots};
    rotation_spline_at(rotations, at, out);
  }
  return out;
}

}  // namespace kinalign
