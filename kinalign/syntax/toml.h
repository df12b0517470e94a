// SPDX-License-Identifier: Apache-2.0
// Reads and writes TOML. No other file includes toml++.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"
#include "kinalign/syntax/value.h"

#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

/// Parses the text and calls `read` with the whole table. All errors get the file's name. The
/// parsed table exists only during the call of `read`, which must copy what it needs.
Result<void> read_toml(std::string_view text, std::string_view name,
                       const std::function<Result<void>(const Value& top)>& read);

/// The key as it stands in [device.KEY]: in quotes if TOML needs them.
std::string toml_key(const std::string& key);
/// The head of a table with a name, such as [device.NAME], as a line after an empty line.
std::string toml_head(const std::string& kind, const std::string& name);
/// The text in quotes, with escapes if TOML needs them.
std::string toml_string(const std::string& text);
/// The texts in the form { a = "b", c = "d" }.
std::string toml_table(const std::map<std::string, std::string>& texts);
/// The texts in the form ["a", "b"].
std::string toml_list(const std::vector<std::string>& texts);

/// The options that differ from their defaults, one per line. `fields` and `defaults` describe two
/// structures of the same type, in the same order.
std::string toml_options(const Fields& fields, const Fields& defaults);
template <class Options>
std::string toml_options(Options options) {
  Options defaults;
  return toml_options(describe(options), describe(defaults));
}

}  // namespace kinalign
