// SPDX-License-Identifier: Apache-2.0
// Reads the entries of a TOML file that a user wrote, in its order. Each fault is reported with its
// line and the nearest known name. Used for manifests and labs.
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
inline namespace v3 {  // toml++ is expensive to include
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

/// The entries in the order of the file; toml++ sorts them by key.
std::vector<TomlEntry> in_file_order(const toml::table& table);

/// The type of a value in words, for the found part of an error: "a table", "a number".
std::string type_of(const toml::node& node);

std::int64_t line_of(const toml::node& node);

/// The key in the form for [device.KEY]: in quotes if it needs them.
std::string toml_key(const std::string& key);
/// The text in quotes, with escapes where TOML needs them.
std::string toml_string(const std::string& text);

/// Advice for a line in which toml++ found a fault, such as [device.my suit], whose name needs
/// quotes; else empty. It is appended to the expected part of an error.
std::string quotes_advice(std::string_view text, std::int64_t line);

/// Reads entries; errors contain the file's name.
class TomlFile {
 public:
  explicit TomlFile(std::string_view name) : name_(name) {}

  /// Parses the text and calls `read` with the whole table. Fails if the text is no TOML, or if
  /// `read` fails.
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
  /// Sets a described option. `beside`: the keys of that table that are no options.
  Result<void> option(const TomlEntry& entry, const Fields& fields, const std::string& table_name,
                      std::vector<std::string> beside) const;

 private:
  std::string name_;
};

}  // namespace kinalign
