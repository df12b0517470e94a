// SPDX-License-Identifier: Apache-2.0
// The quaternions q and -q are the same rotation. In a take each valid rotation gets the sign that
// is nearer to the previous valid rotation, also across gaps and slabs. Plots of the components
// then have no jumps, and users may interpolate components between two rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

/// Chooses the signs of the rotations of one group, row after row.
class RotationSigns {
 public:
  /// `columns`: number of joints or nodes.
  explicit RotationSigns(std::size_t columns) : last_(4 * columns, 0.0) {}

  /// Changes signs in `rotations` [n,columns,4], which are the rows after those of the previous
  /// call. `valid`: [n,columns] or [n]; empty: all are valid.
  void align(std::span<double> rotations, std::span<const std::uint8_t> valid);

 private:
  /// [columns,4] the last valid rotation; zeros before the first one, which change no sign
  std::vector<double> last_;
};

}  // namespace kinalign
