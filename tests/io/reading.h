// SPDX-License-Identifier: Apache-2.0
// Reading a whole text in pieces, for tests of readers.
#pragma once

#include "kinalign/io/layout.h"
#include "kinalign/io/reader.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// What a pass over a text gave.
template <class ReaderType>
struct Read {
  typename ReaderType::Header header;
  typename ReaderType::Frames rows;
  Findings findings;
  std::string error;  // empty: none
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
  if (reader->header() != nullptr) read.header = *reader->header();
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

/// Pieces of 1, 2, 3, ... bytes give what the whole text gives.
template <class MakeReader>
void check_pieces(MakeReader make, std::string_view text) {
  const auto whole = read_all(make(), text);
  for (std::size_t piece = 1; piece < text.size(); ++piece) {
    CAPTURE(piece);
    const auto cut = read_in_pieces(make(), text, piece);
    CHECK(same_rows(cut.rows, whole.rows));
    CHECK(cut.error == whole.error);
    CHECK(cut.findings.size() == whole.findings.size());
  }
}

inline TableLayout layout_of(std::string_view toml) {
  auto layout = parse_layout(toml, "layout.toml");
  if (!layout) FAIL(to_string(layout.error()));
  return *layout;
}

inline TableLayout builtin(std::string_view name) {
  return layout_of(builtin_layout(name).value());
}

inline std::string text_of(const Finding& finding) { return to_string(finding.what); }

}  // namespace kinalign
