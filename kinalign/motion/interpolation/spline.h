// SPDX-License-Identifier: Apache-2.0
// Natural cubic splines at irregular stamps, for all channels of a row together (section 3.2 of the
// HFUT-MMD paper, README.md).
#pragma once

#include <cstddef>
#include <span>

namespace kinalign {

/// This many knots on each side of a place determine the spline there, to less than 2e-18 of a
/// channel's largest value. The influence of a knot at least halves from one knot to the next,
/// because the system's diagonal 2(h + h') is twice the sum of the two numbers beside it.
constexpr std::size_t spline_reach = 60;

/// Rows of C channels at strictly rising times (s, from a nearby origin).
struct Knots {
  std::span<const double> times;   // [T] s, one for each row
  std::span<const double> values;  // [T,C] the rows
  std::size_t channels = 0;
};

/// Fills `bends` [T,C] with the second derivatives of the natural spline (zero at both ends). One
/// factorisation serves all channels. T >= 1; with one or two knots all bends are zero.
void natural_spline(const Knots& knots, std::span<double> bends);

/// The spline's values `out` [N,C] at rising times within [times.front(), times.back()].
void spline_at(const Knots& knots, std::span<const double> bends, std::span<const double> times,
               std::span<double> out);

}  // namespace kinalign
