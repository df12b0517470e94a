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

/// Parses the text and calls `read` with the whole table. All errors get the file's name.
/// `read` runs while the parsed table exists, so it must copy whatever it keeps.
Result<void> read_toml(std::string_view text, std::string_view name,
                       const std::function<Result<void>(const Value& top)>& read);

/// The key in the form for [device.KEY]: in quotes if it needs them.
std::string toml_key(const std::string& key);
/// The head of a table with a name, [kind.NAME], on a line of its own after an empty one.
std::string toml_head(const std::string& kind, const std::string& name);
/// The text in quotes, with escapes where TOML needs them.
std::string toml_string(const std::string& text);
/// Texts as { a = "b", c = "d" }.
std::string toml_table(const std::map<std::string, std::string>& texts);
/// Texts as ["a", "b"].
std::string toml_list(const std::vector<std::string>& texts);

/// The options that differ from their defaults, a line each.
/// `fields` and `defaults` describe two structures of one type, in the same order.
std::string toml_options(const Fields& fields, const Fields& defaults);
template <class Options>
std::string toml_options(Options options) {
  Options defaults;
  return toml_options(describe(options), describe(defaults));
}

}  // namespace kinalign
