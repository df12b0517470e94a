// SPDX-License-Identifier: Apache-2.0
// Decides where the windows of a take are, from the take's stamps alone.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

/// The wanted length, step and rate of windows.
struct WindowGrid {
  std::uint64_t length = 64, step = 32;  // rows
  double rate_hz = 0.0;                  // 0: the rate of the take
};

/// The place of one window in its take. Rows of the window and rows of the take are counted
/// separately, because their rates may differ.
struct WindowPlace {
  Time begin{};                 // stamp of its first row
  std::uint64_t first = 0;      // last row of the take that is not after `begin`
  std::uint64_t take_rows = 0;  // number of rows of the take from `first` on that are read
  std::uint64_t rows = 0;  // less than `length` at the end of the take, or of a stretch before a
                           // gap
};

/// All windows of one take.
struct WindowPlaces {
  std::vector<WindowPlace> places;
  std::uint64_t rows_left_out = 0;  // rows of the take in stretches shorter than half a window
};

/// Places a window every `step` rows. No window crosses a gap, which is a step of more than 1.5
/// times the median. The last window of a stretch ends with the stretch, so that each row is in a
/// window. A stretch of at least half a window gives one window with fewer rows. `stamps` must
/// rise.
WindowPlaces place_windows(std::span<const Time> stamps, const WindowGrid& grid);

}  // namespace kinalign
