// SPDX-License-Identifier: Apache-2.0
// A small tab-separated table with a header line, such as channels.tsv, participants.tsv or
// scans.tsv.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A table. A cell is found by the name of its column, because columns may have any order.
struct TsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  std::optional<std::size_t> column(std::string_view name) const;
};

/// The parts between the delimiters. "a//b" has three parts, and the second is empty.
std::vector<std::string_view> split(std::string_view text, char delimiter);

/// Reads a table. Rows may be longer or shorter than the header line. The last line may be empty.
TsvTable read_tsv(std::string_view text);

/// A cell that contains `text`; "n/a" if the text is empty. Tabs and line ends become blanks.
std::string tsv_cell(std::string_view text);

std::string write_tsv(const TsvTable& table);

}  // namespace kinalign
