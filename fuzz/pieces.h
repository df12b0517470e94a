// SPDX-License-Identifier: Apache-2.0
// The rule for every reader: its rows do not depend on where the file is cut into pieces.
#pragma once

#include "tests/pieces.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace kinalign {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Whether all numbers that a reader gives are finite and can be computed with.
inline bool sound(const PointFrames& rows) {
  const auto finite = [](double x) { return x - x == 0.0; };
  return std::all_of(rows.positions.begin(), rows.positions.end(), finite) &&
         rows.positions.size() == 3 * rows.state.size();
}

inline bool sound(const ImuSamples& rows) {
  const auto finite = [](double x) { return x - x == 0.0; };
  return std::all_of(rows.orientation.begin(), rows.orientation.end(), finite) &&
         std::all_of(rows.acceleration.begin(), rows.acceleration.end(), finite) &&
         std::all_of(rows.angular_velocity.begin(), rows.angular_velocity.end(), finite);
}

/// `make` gives a fresh reader; the text's own bytes decide where it is cut.
template <class MakeReader>
void check_pieces(MakeReader make, std::string_view text) {
  const std::size_t piece = text.empty() ? 1 : 1 + static_cast<unsigned char>(text.back()) % 61;
  const auto whole = read_all(make(), text);
  const auto cut = read_in_pieces(make(), text, piece);
  if (whole.error != cut.error) std::abort();
  if (whole.error.empty() && !whole.has_header) std::abort();  // a good file has a head
  if (!same_rows(whole.rows, cut.rows) || !sound(whole.rows)) std::abort();
}

}  // namespace kinalign
