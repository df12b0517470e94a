// SPDX-License-Identifier: Apache-2.0
// The options on the command line of kinalign_clock_table.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct Wanted {
  enum class Output : std::uint8_t { tables, bars, markdown, help };
  Output output = Output::tables;
  double minutes = 1.0;
  std::int64_t seeds = 20;
  std::optional<std::int64_t> first;  // absent: a random seed, so that seeds are new in each run
  std::string links = "ABCDEFG";
  bool bursts = false;
};

/// Fails with an Error whose `file` is the wrong flag: "--minutes".
Result<Wanted> wanted_from(const std::vector<std::string>& words);

/// The text that --help prints.
extern const std::string_view help_page;

}  // namespace kinalign
