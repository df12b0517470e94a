// SPDX-License-Identifier: Apache-2.0
// Entries of a TOML file that a user wrote, in its order, each fault with its line and the nearest
// known name: for the readers of manifests and labs.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toml {
inline namespace v3 {  // toml++ is heavy to include
class node;
class table;
}  // namespace v3
}  // namespace toml

namespace kinalign {

using Texts = std::map<std::string, std::string>;

/// A key and its value.
struct TomlEntry {
  std::string key;
  const toml::node* value;
};

/// In the order of the file; toml++ sorts by key.
std::vector<TomlEntry> in_file_order(const toml::table& table);

/// "a table", "a number": what was found where something else was wanted.
std::string type_of(const toml::node& node);

std::int64_t line_of(const toml::node& node);

/// As it stands in [device.KEY]: in quotes where it needs them.
std::string toml_key(const std::string& key);
/// A text in quotes, with what TOML wants escaped.
std::string toml_string(const std::string& text);

/// Of a line in which toml++ found a fault, such as [device.my suit], whose name has to stand in
/// quotes: how; else empty. For the end of what was expected.
std::string quotes_advice(std::string_view text, std::int64_t line);

/// Reads entries; its name stands in the errors.
class TomlFile {
 public:
  explicit TomlFile(std::string_view name) : name_(name) {}

  /// `read` gets the whole table; fails where the text is no TOML, or as `read` does.
  Result<void> parse(std::string_view text,
                     const std::function<Result<void>(const toml::table&)>& read) const;

  Failure at(const toml::node& node, Error error) const;
  Failure wrong(const TomlEntry& entry, const std::string& wanted) const;
  Failure unknown(const TomlEntry& entry, const std::string& what,
                  const std::vector<std::string>& known) const;

  Result<std::string> text(const TomlEntry& entry) const;
  Result<std::reference_wrapper<const toml::table>> table(const TomlEntry& entry) const;
  /// Pairs of texts: { SpineBase = "Hips" }.
  Result<Texts> texts(const TomlEntry& entry) const;
  /// A described option; `beside` are the keys of that table that are none.
  Result<void> option(const TomlEntry& entry, const Fields& fields, const std::string& table_name,
                      std::vector<std::string> beside) const;

 private:
  std::string name_;
};

}  // namespace kinalign
