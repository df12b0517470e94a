// SPDX-License-Identifier: Apache-2.0
// Each option is described once: name, meaning, unit, range. The flags of a command, its TOML keys,
// its --help, its shell completion and the JSON in a take all use this description.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// One option of a structure: the address of its value, and the values allowed. Tables and lists of
/// numbers stand in files only; they have no flag.
struct Field {
  std::string name;     // the name in TOML and JSON (gap_ms); the flag is --gap-ms
  std::string meaning;  // one line for --help
  std::variant<bool*, double*, std::int64_t*, std::string*, std::optional<double>*,
               std::optional<std::int64_t>*, std::vector<std::string>*, std::vector<double>*,
               std::map<std::string, std::string>*, std::map<std::string, double>*,
               std::map<std::string, std::vector<double>>*>
      value;
  double least = -unlimited;  // numbers only, each of them; they must also be finite
  double most = unlimited;
  std::vector<std::string> choices{};  // strings only; empty: any text
  std::string stands_for{};  // placeholder of the value in --help: "FOLDER"; empty: from the name
  std::size_t count = 0;     // of a list of numbers: how many; 4 are a rotation w,x,y,z; 0: any
};

using Fields = std::vector<Field>;

}  // namespace kinalign
