// SPDX-License-Identifier: Apache-2.0
// The law of every reader: rows do not depend on where the file is cut into pieces.
#pragma once

#include "kinalign/io/reader.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

namespace kinalign {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

template <class ReaderType>
struct Outcome {
  typename ReaderType::Frames rows;
  bool failed = false;
  std::string error;
};

template <class ReaderType>
Outcome<ReaderType> outcome(std::unique_ptr<ReaderType> reader, std::string_view text,
                            std::size_t piece) {
  Outcome<ReaderType> out;
  Result<void> result;
  for (std::size_t at = 0; at < text.size() && result; at += piece) {
    result = reader->feed(text.substr(at, piece), out.rows);
  }
  if (result) result = reader->finish(out.rows);
  out.failed = !result;
  if (!result) out.error = to_string(result.error());
  if (result && reader->header() == nullptr) std::abort();  // a good file has a head
  return out;
}

inline bool same_rows(const PointFrames& a, const PointFrames& b) {
  return a.stamps == b.stamps && a.positions == b.positions && a.state == b.state;
}

inline bool same_rows(const ImuSamples& a, const ImuSamples& b) {
  return a.stamps == b.stamps && a.orientation == b.orientation &&
         a.acceleration == b.acceleration && a.angular_velocity == b.angular_velocity &&
         a.valid == b.valid;
}

/// Numbers that a reader lets through can be computed with.
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

/// `make` gives a fresh reader; the text's own bytes say how it is cut.
template <class MakeReader>
void check_pieces(MakeReader make, std::string_view text) {
  const std::size_t piece = text.empty() ? 1 : 1 + static_cast<unsigned char>(text.back()) % 61;
  const auto whole = outcome(make(), text, std::max<std::size_t>(text.size(), 1));
  const auto cut = outcome(make(), text, piece);
  if (whole.failed != cut.failed || whole.error != cut.error) std::abort();
  if (!same_rows(whole.rows, cut.rows) || !sound(whole.rows)) std::abort();
}

}  // namespace kinalign
