// SPDX-License-Identifier: Apache-2.0
// Options are described once: name, meaning, unit, range. The flags of a verb, its TOML keys, its
// --help, its shell completion and the JSON in a take all come from the description.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// One option of a structure: where its value lives and what may stand there.
struct Field {
  std::string name;     // as in TOML and JSON (gap_ms); the flag is --gap-ms
  std::string meaning;  // one line for --help
  std::variant<bool*, double*, std::int64_t*, std::string*, std::optional<double>*,
               std::optional<std::int64_t>*, std::vector<std::string>*>
      value;
  double least = -unlimited;  // numbers only, which are finite all the same
  double most = unlimited;
  std::vector<std::string> choices{};  // strings only; empty: any text
  std::string stands_for{};            // in --help, for the value: "FOLDER"; empty: by its name
};

using Fields = std::vector<Field>;

}  // namespace kinalign
