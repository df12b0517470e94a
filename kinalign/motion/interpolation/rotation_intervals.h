// SPDX-License-Identifier: Apache-2.0
// The intervals between neighbouring rotations. Only the files of the rotation spline use this
// header.
#pragma once

#include "kinalign/motion/interpolation/rotation_spline.h"
#include "kinalign/motion/trigonometry.h"

#include <array>
#include <vector>

namespace kinalign {

/// X, y, z in separate arrays, so that loops become vector code.
using Columns = std::array<std::vector<double>, 3>;

/// For each of n intervals its length, and the rotation vector from its left knot to its right
/// knot.
struct RotationIntervals {
  std::vector<double> length;  // [n] s, of each interval
  Columns vector;              // [n] at most pi long, rad

  std::size_t size() const { return length.size(); }
};

/// Fills `to` with the intervals between `knots`, of which there must be at least two. Earlier
/// contents are replaced.
void measure_intervals(const RotationKnots& knots, RotationIntervals& to);

/// The derivatives of each interval's rotation vector at its two ends, rad/s.
struct RotationSlopes {
  Columns begin, end;  // [n] at the left and the right knot of each interval
};

/// Quantities that depend only on the length of a rotation vector r. Let H be the rotation by r /
/// 2, and let D keep the part of a vector along r and shrink the part across it:
///   H = half_w + half_r r (as a quaternion),  D v = across v + along (r . v) r.
/// The matrix W(r) = H^-1 D converts the derivative of a rotation vector to an angular rate. The
/// part of the angular acceleration that is quadratic in the angular rate w is
///   b(r, w) = (square |w|^2 + product (r . w)^2) r - mixed (r . w) w.
struct TurnParts {
  double half_w, half_r;
  double across, along;
  double square, product, mixed;
};

/// Computes these quantities from x, the squared length of r, at most pi^2. No nearly equal numbers
/// are subtracted, so no digits are lost.
KA_INLINE TurnParts turn_parts(double x) {
  constexpr auto cosine_rest = alternating_series<8>(2), sine_rest = alternating_series<8>(3);
  constexpr auto product = [] {
    auto c = alternating_series<11>(6);
    for (std::size_t k = 0; k < c.size(); ++k) c[k] = 4.0 * c[k] - alternating_series<11>(5)[k];
    return c;
  }();
  const double y = x / 16.0;  // square of a quarter of the angle
  const double c = polynomial(cosine_rest, y), s = polynomial(sine_rest, y);
  /// The cosine of a quarter of the angle, and its sine divided by the quarter of the angle.
  const double cosine = 1.0 - y * c, sine = 1.0 - y * s;
  const double across = cosine * sine, along = (c + s - y * c * s) / 16.0;
  const double sagitta = sine * sine / 8.0;  // (1 - cosine of half the angle) / x
  const double widen = 1.0 / across;
  return {cosine,
          sine / 4.0,
          across,
          along,
          (along + sagitta * (1.0 - x * along)) * widen * widen,
          polynomial(product, x) * widen * widen,
          2.0 * (sagitta - along) * widen};
}

}  // namespace kinalign
