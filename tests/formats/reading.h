// SPDX-License-Identifier: Apache-2.0
// Helpers to run readers and layouts in tests.
#pragma once

#include "tests/pieces.h"

#include "kinalign/formats/table/layout.h"

#include <doctest/doctest.h>

#include <string>
#include <string_view>

namespace kinalign {

/// Checks that pieces of 1, 2, 3, ... bytes give the same as the whole text.
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
