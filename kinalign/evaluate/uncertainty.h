// SPDX-License-Identifier: Apache-2.0
// Tests of a stated uncertainty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinalign {

/// A radius is stated for each cell and should contain a certain share of all errors. The stated
/// radii are informative if they are smaller on average than the one common radius that contains as
/// many errors. Sums of several takes may be added, since all members are counts or sums.
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
  /// The smallest radius, in whole millimetres, that contains as large a share. 0 without cells.
  double one_radius_m() const;
};

}  // namespace kinalign
