// SPDX-License-Identifier: Apache-2.0
// Compares the uncertainty that a method states with its errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinalign {

/// A method states a radius for each joint in each frame (a cell). A certain share of all errors
/// should be smaller than the radius. The stated radii are informative if their mean is smaller
/// than the one common radius that contains as many errors. Sums of several takes may be added,
/// since all members are counts or sums.
struct RadiusMarks {
  std::size_t cells = 0, within = 0;  // within: the error is at most the stated radius
  double sum_m = 0.0;                 // sum of the stated radii
  /// Histogram [E] of the errors in bins of one millimetre. The last of 2,000 bins contains all
  /// larger errors, too.
  std::vector<std::uint32_t> errors{};

  void add(double error_m, double radius_m);
  void add(const RadiusMarks& other);

  double covered() const;        // share of errors within the stated radius; 0 without cells
  double mean_radius_m() const;  // 0 without cells
  /// The smallest common radius, in whole millimetres, that contains as many errors as the stated
  /// radii. 0 without cells.
  double one_radius_m() const;
};

}  // namespace kinalign
