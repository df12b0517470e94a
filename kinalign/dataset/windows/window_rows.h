// SPDX-License-Identifier: Apache-2.0
// Reads the rows of one window from a take.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/windows/window_places.h"
#include "kinalign/formats/take/take_hdf5.h"

namespace kinalign {

/// Reads the `grid.length` rows of a window into `out`. If the window has fewer rows, its last row
/// is repeated, and no cell of the added rows is valid. At the take's own rate, rows are copied.
/// At another rate, rows are interpolated between two rows of the take: vectors on the straight
/// line, rotations on the shorter arc (slerp). A cell is valid if it is valid in both rows. It gets
/// the worse state of the two, and the larger interval and distance. There is no low-pass filter
/// before, so motion faster than half the new rate is aliased.
/// `raw`: memory for the take's rows.
Result<void> read_window(TakeReader& reader, const WindowPlace& place, const WindowGrid& grid,
                         TakeSlab& raw, TakeSlab& out);

/// The share of valid cells in one stream of a window, over its first `rows` rows.
double valid_share(const TakeSlab& window, std::size_t stream, std::uint64_t rows);

}  // namespace kinalign
