// SPDX-License-Identifier: Apache-2.0
// q and -q are one rotation. In a take each valid one has the sign that is nearer to the valid one
// before it, over gaps and slabs too: plots of its parts do not jump, and what lies between two
// rows may be interpolated part by part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

/// Of the rotations of one group, row after row.
class RotationSigns {
 public:
  /// `columns`: joints or nodes.
  explicit RotationSigns(std::size_t columns) : last_(4 * columns, 0.0) {}

  /// `rotations` [n,columns,4], behind those of the calls before; `valid` [n,columns] or [n], or
  /// empty where all are.
  void align(std::span<double> rotations, std::span<const std::uint8_t> valid);

 private:
  std::vector<double> last_;  // [columns,4] the last valid one; zeros, which turn none, before it
};

}  // namespace kinalign
