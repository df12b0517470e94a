// SPDX-License-Identifier: Apache-2.0
// The rows of one window, out of a take's.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/windows/window_places.h"
#include "kinalign/formats/take/take_hdf5.h"

namespace kinalign {

/// Reads the `grid.length` rows of a window into `out`. Where the window has fewer rows, its last
/// one is repeated, and no cell of these rows is valid.
/// At the take's own rate rows are copied. At another rate they lie between two of the take's:
/// vectors on the line between both, rotations on the shorter arc (slerp). Such a cell is valid if
/// both are, its state is the lesser, its interval and its distance are the larger. No filter is
/// applied before: motion faster than half the new rate folds back.
/// `raw`: room for the take's rows.
Result<void> read_window(TakeReader& reader, const WindowPlace& place, const WindowGrid& grid,
                         TakeSlab& raw, TakeSlab& out);

/// The share of valid cells of a window's stream, over its first `rows` rows.
double valid_share(const TakeSlab& window, std::size_t stream, std::uint64_t rows);

}  // namespace kinalign
