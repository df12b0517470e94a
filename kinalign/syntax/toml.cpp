// SPDX-License-Identifier: Apache-2.0
#include "kinalign/syntax/toml.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

namespace kinalign {

namespace {

using Kind = Value::Kind;

/// Advice for a line in which toml++ found a fault: a table name such as [device.my suit] needs
/// quotes. The result is empty for other lines. The name begins after the brackets and the first
/// dot, and ends at the first closing bracket.
std::string quotes_advice(std::string_view text, std::int64_t line) {
  for (std::int64_t at = 1; at < line; ++at) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return "";
    text.remove_prefix(end + 1);
  }
  // The lines before the fault are removed. Now the text is cut after its first line.
  text = text.substr(0, text.find_first_of("\r\n"));
  const auto begin = text.find_first_not_of(" \t["), end = text.find(']');
  if (!text.starts_with('[') || end == std::string_view::npos || begin >= end) return "";
  const std::string_view key = text.substr(begin, end - begin);
  const auto dot = key.find('.');
  const std::string_view name = dot == std::string_view::npos ? key : key.substr(dot + 1);
  // If the name contains a dot or a quote, quotes may not be the right advice, so none is given.
  const bool blank = name.find(' ') != std::string_view::npos;
  if (!blank || name.find_first_of(".\"'") != std::string_view::npos) return "";
  const std::string_view table = key.substr(0, key.size() - name.size());
  return " (a name with blanks stands in quotes: [" + shown(table) + "\"" + shown(name) + "\"])";
}

/// The longest path of a value in bytes. Every value contains its path, and value_of() recurses
/// once per part. Without a limit, a hostile file could use up memory and stack.
constexpr std::size_t longest_path = 250;

/// The first node whose path is too long; nullptr if there is none. `before`: the length of the
/// path above the node, bytes.
const toml::node* beyond_limit(const toml::node& node, std::size_t before) {
  if (before > longest_path) return &node;
  const toml::node* found = nullptr;
  if (const auto* list = node.as_array()) {
    for (const toml::node& one : *list) {
      if (found == nullptr) found = beyond_limit(one, before);
    }
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, one] : *table) {
      if (found == nullptr) found = beyond_limit(one, before + key.str().size() + 1);
    }
  }
  return found;
}

// Lists and tables contain nodes, so this function and entries_in_order() call each other.
Value value_of(const toml::node& node, std::string key, std::string path);

/// The entries in the order of the file, because toml++ sorts them by key.
std::vector<Value> entries_in_order(const toml::table& table, const std::string& path) {
  std::vector<std::pair<std::string, const toml::node*>> entries;
  for (const auto& [key, value] : table) entries.emplace_back(key.str(), &value);
  // Errors and streams keep the order of the file instead of the alphabet.
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    const auto& at = a.second->source().begin;
    const auto& bt = b.second->source().begin;
    return at.line != bt.line ? at.line < bt.line : at.column < bt.column;
  });
  // Messages show the whole path of an entry, for example "stream.mocap.gap_ms".
  const std::string before = path.empty() ? "" : path + ".";
  std::vector<Value> out;
  out.reserve(entries.size());
  for (const auto& [key, node] : entries) out.push_back(value_of(*node, key, before + key));
  return out;
}

Value value_of(const toml::node& node, std::string key, std::string path) {
  Value out;
  out.key = std::move(key);
  out.path = std::move(path);
  // A node without a position in the file gets line 1, because line 0 stands for JSON.
  out.line = std::max<std::int64_t>(node.source().begin.line, 1);
  // Only dates and times are not recognised by the tests below, so they are the default.
  out.kind = Kind::date;
  if (const auto* truth = node.as_boolean()) out.set(Kind::truth, truth->get());
  if (const auto* whole = node.as_integer()) out.set(Kind::whole, whole->get());
  if (const auto* number = node.as_floating_point()) out.set(Kind::number, number->get());
  if (const auto* text = node.as_string()) out.set(Kind::text, text->get());
  if (const auto* list = node.as_array()) {
    out.kind = Kind::list;
    for (const toml::node& one : *list) out.items.push_back(value_of(one, out.key, out.path));
  }
  if (const auto* table = node.as_table()) {
    out.kind = Kind::table;
    out.items = entries_in_order(*table, out.path);
  }
  return out;
}

std::string toml_text(bool value) { return value ? "true" : "false"; }
std::string toml_text(std::int64_t value) { return std::to_string(value); }
std::string toml_text(const std::string& value) { return toml_string(value); }
std::string toml_text(double value) {  // the shortest text that reads back exactly
  // Whole numbers get a point, because TOML would read "3" as an integer.
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
template <class One>
std::string toml_text(const std::optional<One>& value) {
  return value ? toml_text(*value) : "";
}
template <class One>
std::string toml_text(const std::vector<One>& values) {
  std::string text;
  for (const One& one : values) text += (text.empty() ? "" : ", ") + toml_text(one);
  return "[" + text + "]";
}
template <class One>
std::string toml_text(const std::map<std::string, One>& values) {
  std::string text;
  for (const auto& [key, one] : values) {
    text += (text.empty() ? "" : ", ") + toml_key(key) + " = " + toml_text(one);
  }
  return "{ " + text + " }";
}

/// The line of the first key with more parts than longest_path allows; 0 if there is none. toml++
/// recurses once per part, so such a key must not reach it.
std::int64_t line_of_deep_key(std::string_view text) {
  std::int64_t line = 1;
  std::size_t dots = 0;
  for (const char c : text) {
    if (c == '.' && ++dots > longest_path) return line;
    if (c == '\n') ++line;
    if (std::string_view("=,{}\n").find(c) != std::string_view::npos) dots = 0;
  }
  return 0;
}

Failure too_long(std::string_view name, std::int64_t line) {
  return Failure(Error{std::string(name), line, "keys of at most 250 bytes with their tables",
                       "a longer key"});
}

}  // namespace

Result<void> read_toml(std::string_view text, std::string_view name,
                       const std::function<Result<void>(const Value& top)>& read) {
  if (const std::int64_t line = line_of_deep_key(text); line > 0) return too_long(name, line);
  // toml++ throws exceptions. They are caught here and become errors with a line.
  try {
    const toml::table top = toml::parse(text, name);
    if (const toml::node* node = beyond_limit(top, 0)) {
      return too_long(name, static_cast<std::int64_t>(node->source().begin.line));
    }
    return read(value_of(top, "", "")).map_error([&](Error error) {
      error.file = std::string(name);
      return error;
    });
  } catch (const toml::parse_error& error) {
    const auto line = static_cast<std::int64_t>(error.source().begin.line);
    return Failure(Error{std::string(name), line, "TOML" + quotes_advice(text, line),
                         "a fault in it: " + std::string(error.description())});
  }
}

std::string toml_key(const std::string& key) {
  const auto bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  if (!key.empty() && std::all_of(key.begin(), key.end(), bare)) return key;
  return toml_string(key);
}

std::string toml_head(const std::string& kind, const std::string& name) {
  return "\n[" + kind + "." + toml_key(name) + "]\n";
}

std::string toml_string(const std::string& text) {
  std::ostringstream quoted;
  quoted << toml::toml_formatter(toml::value<std::string>(text), toml::format_flags::none);
  return quoted.str();
}

std::string toml_table(const std::map<std::string, std::string>& texts) { return toml_text(texts); }
std::string toml_list(const std::vector<std::string>& texts) { return toml_text(texts); }

std::string toml_options(const Fields& fields, const Fields& defaults) {
  const auto write = [](const auto* value) { return toml_text(*value); };
  std::string text;
  // The texts of the values are compared instead of the values, so one function serves all types.
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string value = std::visit(write, fields[i].value);
    if (value == std::visit(write, defaults[i].value)) continue;
    text += fields[i].name + " = " + value + "\n";
  }
  return text;
}

}  // namespace kinalign
