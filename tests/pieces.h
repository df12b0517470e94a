// SPDX-License-Identifier: Apache-2.0
// Reading a whole text in pieces, for tests and fuzz targets of readers.
#pragma once

#include "kinalign/formats/reader.h"

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

namespace kinalign {

/// The result of one pass over a text.
template <class ReaderType>
struct Read {
  typename ReaderType::Header header;
  typename ReaderType::Frames rows;
  Findings findings;
  std::string error;  // empty: none
  bool has_header = false;
};

template <class ReaderType>
Read<ReaderType> read_in_pieces(std::unique_ptr<ReaderType> reader, std::string_view text,
                                std::size_t piece) {
  Read<ReaderType> read;
  Result<void> result;
  for (std::size_t at = 0; at < text.size() && result; at += piece) {
    result = reader->feed(text.substr(at, piece), read.rows);
  }
  if (result) result = reader->finish(read.rows);
  if (!result) read.error = to_string(result.error());
  read.has_header = reader->header() != nullptr;
  if (read.has_header) read.header = *reader->header();
  read.findings = reader->findings;
  return read;
}

template <class ReaderType>
Read<ReaderType> read_all(std::unique_ptr<ReaderType> reader, std::string_view text) {
  return read_in_pieces(std::move(reader), text, std::max<std::size_t>(text.size(), 1));
}

inline bool same_rows(const PointFrames& a, const PointFrames& b) {
  return a.stamps == b.stamps && a.positions == b.positions && a.state == b.state;
}

inline bool same_rows(const ImuSamples& a, const ImuSamples& b) {
  return a.stamps == b.stamps && a.orientation == b.orientation &&
         a.acceleration == b.acceleration && a.angular_velocity == b.angular_velocity &&
         a.valid == b.valid;
}

}  // namespace kinalign
