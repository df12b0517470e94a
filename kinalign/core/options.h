// SPDX-License-Identifier: Apache-2.0
// Each option is described once, with name, meaning, unit and range. The description serves a
// command's flags, its TOML keys, its --help, its shell completion and the JSON in a take.
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

/// One option of a structure: the address of its value, and the allowed values. Tables and lists of
/// numbers can be set in files only, not by a flag.
struct Field {
  std::string name;     // the name in TOML and JSON (gap_ms); the flag is --gap-ms
  std::string meaning;  // one line for --help
  std::variant<bool*, double*, std::int64_t*, std::string*, std::optional<double>*,
               std::optional<std::int64_t>*, std::vector<std::string>*, std::vector<double>*,
               std::map<std::string, std::string>*, std::map<std::string, double>*,
               std::map<std::string, std::vector<double>>*>
      value;
  double least = -unlimited;  // for numbers and each number of a list; they must be finite, too
  double most = unlimited;
  std::vector<std::string> choices{};  // for strings only; empty: any text is allowed
  std::string stands_for{};            // placeholder in --help, "FOLDER"; empty: made from the name
  std::size_t count = 0;               // length of a list of numbers; 4: a rotation w,x,y,z; 0: any
};

using Fields = std::vector<Field>;

}  // namespace kinalign
