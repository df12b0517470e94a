// SPDX-License-Identifier: Apache-2.0
// Where the windows of a take lie, by its stamps alone.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

struct WindowGrid {
  std::uint64_t length = 64, step = 32;  // rows
  double rate_hz = 0.0;                  // 0: the take's own rows
};

struct WindowPlace {
  Time begin{};                 // of its first row
  std::uint64_t first = 0;      // row of the take at `begin` or before it
  std::uint64_t take_rows = 0;  // rows of the take from there to the window's end, or just behind
  std::uint64_t rows = 0;  // fewer than `length` where the take, or the stretch before a gap, ends
};

struct WindowPlaces {
  std::vector<WindowPlace> places;
  std::uint64_t rows_left_out = 0;  // of the take: in stretches shorter than half a window
};

/// Windows each `step` rows. None crosses a gap, which is a step of more than 1.5 times the median.
/// The last one of a stretch ends with it, so that each of its rows lies in a window. A stretch of
/// half a window and more gives one window with fewer rows. `stamps` rise.
WindowPlaces place_windows(std::span<const Time> stamps, const WindowGrid& grid);

}  // namespace kinalign
