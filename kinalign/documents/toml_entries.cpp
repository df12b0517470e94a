// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/toml_entries.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/documents/option_values.h"

#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace kinalign {

namespace {

/// The value of a TOML node for an option; absent for other types.
std::optional<OptionValue> option_value(const toml::node& node) {
  if (const auto* truth = node.as_boolean()) return truth->get();
  if (const auto* whole = node.as_integer()) return whole->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* text = node.as_string()) return text->get();
  const auto* array = node.as_array();
  if (array == nullptr) return std::nullopt;
  std::vector<std::string> out;
  for (const toml::node& one : *array) {
    const auto* text = one.as_string();
    if (text == nullptr) return std::nullopt;
    out.push_back(text->get());
  }
  return out;
}

}  // namespace

std::vector<TomlEntry> in_file_order(const toml::table& table) {
  std::vector<TomlEntry> out;
  for (const auto& [key, value] : table) out.push_back({std::string(key.str()), &value});
  std::stable_sort(out.begin(), out.end(), [](const TomlEntry& a, const TomlEntry& b) {
    const auto& at = a.value->source().begin;
    const auto& bt = b.value->source().begin;
    return at.line != bt.line ? at.line < bt.line : at.column < bt.column;
  });
  return out;
}

std::string type_of(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  if (node.is_string()) return "a text";
  if (node.is_number()) return "a number";
  if (node.is_boolean()) return "true or false";
  return "a date or time";
}

std::string toml_key(const std::string& key) {
  const auto bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  if (!key.empty() && std::all_of(key.begin(), key.end(), bare)) return key;
  return toml_string(key);
}

std::string toml_string(const std::string& text) {
  std::ostringstream quoted;
  quoted << toml::toml_formatter(toml::value<std::string>(text), toml::format_flags::none);
  return quoted.str();
}

std::int64_t line_of(const toml::node& node) {
  return static_cast<std::int64_t>(node.source().begin.line);
}

std::string quotes_advice(std::string_view text, std::int64_t line) {
  for (std::int64_t at = 1; at < line; ++at) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return "";
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find_first_of("\r\n"));
  const auto begin = text.find_first_not_of(" \t["), end = text.find(']');
  if (!text.starts_with('[') || end == std::string_view::npos || begin >= end) return "";
  const std::string_view key = text.substr(begin, end - begin);
  const auto dot = key.find('.');
  const std::string_view name = dot == std::string_view::npos ? key : key.substr(dot + 1);
  const bool blank = name.find(' ') != std::string_view::npos;
  if (!blank || name.find_first_of(".\"'") != std::string_view::npos) return "";
  const std::string_view table = key.substr(0, key.size() - name.size());
  return " (a name with blanks stands in quotes: [" + shown(table) + "\"" + shown(name) + "\"])";
}

Result<void> TomlFile::parse(std::string_view text,
                             const std::function<Result<void>(const toml::table&)>& read) const {
  try {
    return read(toml::parse(text, name_));
  } catch (const toml::parse_error& error) {
    const auto line = static_cast<std::int64_t>(error.source().begin.line);
    return Failure(Error{name_, line, "TOML" + quotes_advice(text, line),
                         "a fault in it: " + std::string(error.description())});
  }
}

Failure TomlFile::at(const toml::node& node, Error error) const {
  error.file = name_;
  error.line = line_of(node);
  return Failure(std::move(error));
}

Failure TomlFile::wrong(const TomlEntry& entry, const std::string& wanted) const {
  return at(*entry.value, Error{"", 0, entry.key + " as " + wanted, type_of(*entry.value)});
}

Failure TomlFile::unknown(const TomlEntry& entry, const std::string& what,
                          const std::vector<std::string>& known) const {
  return at(*entry.value, unknown_name(entry.key, what, known));
}

Result<std::string> TomlFile::text(const TomlEntry& entry) const {
  const auto* value = entry.value->as_string();
  if (value == nullptr) return wrong(entry, "a text");
  return value->get();
}

Result<std::reference_wrapper<const toml::table>> TomlFile::table(const TomlEntry& entry) const {
  const auto* value = entry.value->as_table();
  if (value == nullptr) return wrong(entry, "a table");
  return std::cref(*value);
}

Result<Texts> TomlFile::texts(const TomlEntry& entry) const {
  Texts out;
  for (const TomlEntry& one : in_file_order(KA_TRY(table(entry)))) out[one.key] = KA_TRY(text(one));
  return out;
}

Result<void> TomlFile::option(const TomlEntry& entry, const Fields& fields,
                              const std::string& table_name,
                              std::vector<std::string> beside) const {
  const Field* field = find_field(fields, entry.key);
  if (field == nullptr) {
    for (const Field& known : fields) beside.push_back(known.name);
    return unknown(entry, "a key of [" + table_name + "]", beside);
  }
  const auto value = option_value(*entry.value);
  if (!value) return wrong(entry, "a single value");
  auto done = assign(*field, *value);
  return done ? Result<void>() : at(*entry.value, std::move(done).error());
}

}  // namespace kinalign
