// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/rotation_signs.h"

#include "kinalign/motion/arrays.h"

namespace kinalign {

void RotationSigns::align(std::span<double> rotations, std::span<const std::uint8_t> valid) {
  const std::size_t columns = last_.size() / 4, cells = rotations.size() / 4;
  // `valid` has one value for each cell or, for a skeleton, one for each row.
  const bool by_cell = valid.size() == cells;
  for (std::size_t i = 0; i < cells; ++i) {
    if (!valid.empty() && valid[by_cell ? i : i / columns] == 0) continue;
    Quat q = quat(rotations, i);
    // If the dot product is negative, -q is nearer to the last rotation.
    if (q.dot(quat(last_, i % columns)) < 0.0) {
      q.coeffs() = -q.coeffs();
      put_quat(rotations, i, q);
    }
    put_quat(last_, i % columns, q);
  }
}

}  // namespace kinalign
