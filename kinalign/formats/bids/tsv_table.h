// SPDX-License-Identifier: Apache-2.0
// A small tab-separated table with a header line: channels.tsv, participants.tsv, scans.tsv.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A cell is found by the name of its column, since columns may stand in any order.
struct TsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  std::optional<std::size_t> column(std::string_view name) const;
};

/// The parts between the delimiters: "a//b" has three, of which one is empty.
std::vector<std::string_view> split(std::string_view text, char delimiter);

/// Rows may be longer or shorter than the header line. The last line may be empty.
TsvTable read_tsv(std::string_view text);

/// A cell for `text`: "n/a" if it is empty; tabs and line ends become blanks.
std::string tsv_cell(std::string_view text);

std::string write_tsv(const TsvTable& table);

}  // namespace kinalign
