// SPDX-License-Identifier: Apache-2.0
// Sine, cosine and arctangent as polynomials of the squared argument, for hot loops. They become
// vector code and, unlike the C library's functions, give the same bits on every processor. No
// square roots are needed: sin(x) = x * sine_ratio(x^2), so weights that depend on an angle need
// only its square.
#pragma once

#include "kinalign/motion/targets.h"

#include <array>
#include <cstddef>
#include <utility>

namespace kinalign {

/// Evaluates a polynomial by Horner's rule; coefficients from the lowest power on.
template <std::size_t terms>
KA_INLINE double polynomial(const std::array<double, terms>& coefficients, double x) {
  double sum = coefficients[terms - 1];
  [&]<std::size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) {
    ((sum = sum * x + coefficients[terms - 2 - i]), ...);
  }
  (std::make_index_sequence<terms - 1>{});
  return sum;
}

/// The coefficients of 1/first! - x/(first+2)! + x^2/(first+4)! - ..., where x is the squared
/// angle. `first` 0: cosine; 1: sine divided by its argument; 4 and 5: the rest of these two series
/// after their first two terms.
template <std::size_t terms>
constexpr std::array<double, terms> alternating_series(int first) {
  std::array<double, terms> c{};
  long double factorial = 1.0L;
  for (int i = 2; i <= first; ++i) factorial *= i;
  for (std::size_t k = 0; k < terms; ++k) {
    c[k] = static_cast<double>((k % 2 == 0 ? 1.0L : -1.0L) / factorial);
    const auto next = static_cast<long double>(first) + 2.0L * static_cast<long double>(k);
    factorial *= (next + 1.0L) * (next + 2.0L);
  }
  return c;
}

/// sin(x) / x as a function of y = x^2, y in [0, (pi/2)^2], exact to 2e-16.
KA_INLINE double sine_ratio(double y) {
  constexpr auto c = alternating_series<12>(1);
  return polynomial(c, y);
}

/// cos(x) as a function of y = x^2, y in [0, (pi/2)^2], exact to 3e-16.
KA_INLINE double cosine(double y) {
  constexpr auto c = alternating_series<13>(0);
  return polynomial(c, y);
}

/// atan(t) / t as a function of x = t^2, t in [0, 1], exact to 3e-16. Interpolated at the 20
/// Chebyshev points of x in [0, 1] in 70-digit arithmetic; without rounding the error is 3e-17.
KA_INLINE double arctangent_ratio(double x) {
  constexpr std::array<double, 20> c{1.0,
                                     -0.333333333333307,
                                     0.1999999999964796,
                                     -0.14285714266926733,
                                     0.11111110578002083,
                                     -0.090908997932173413,
                                     0.076921989974582938,
                                     -0.066657649106897227,
                                     0.058768281144872724,
                                     -0.052374234719188166,
                                     0.046687453048485289,
                                     -0.040811247503178855,
                                     0.033871267027006748,
                                     -0.025568623644371739,
                                     0.016719596063507387,
                                     -0.0089910805426582589,
                                     0.0037511384839651407,
                                     -0.0011252544302234643,
                                     0.00021423810738603941,
                                     -1.9342347592892293e-05};
  return polynomial(c, x);
}

}  // namespace kinalign
