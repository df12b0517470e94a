// SPDX-License-Identifier: Apache-2.0
// Places the windows of a take, by its stamps alone.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

/// The wanted form of windows.
struct WindowGrid {
  std::uint64_t length = 64, step = 32;  // rows
  double rate_hz = 0.0;                  // 0: the take's own rows
};

/// The place of one window in its take. Both the window's rows and the take's rows are counted,
/// because they differ if the rates differ.
struct WindowPlace {
  Time begin{};                 // stamp of its first row
  std::uint64_t first = 0;      // row of the take at `begin` or before it
  std::uint64_t take_rows = 0;  // rows of the take from there to the window's end, or just after it
  std::uint64_t rows = 0;  // less than `length` at the end of the take, or of a stretch before a
                           // gap
};

/// All windows of one take.
struct WindowPlaces {
  std::vector<WindowPlace> places;
  std::uint64_t rows_left_out = 0;  // rows of the take in stretches shorter than half a window
};

/// Places a window each `step` rows. No window crosses a gap, which is a step of more than 1.5
/// times the median. The last window of a stretch ends with it, so that each row is in a window. A
/// stretch of at least half a window gives one window with fewer rows. `stamps` rise.
WindowPlaces place_windows(std::span<const Time> stamps, const WindowGrid& grid);

}  // namespace kinalign
