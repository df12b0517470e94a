// SPDX-License-Identifier: Apache-2.0
// Written by hand, value by value: toml++ sorts tables by name, but the order of streams matters.
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/documents/toml_entries.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

namespace kinalign {

namespace {

std::string toml_text(bool value) { return value ? "true" : "false"; }
std::string toml_text(std::int64_t value) { return std::to_string(value); }
std::string toml_text(double value) {  // the shortest text that reads back exactly
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
std::string toml_text(const std::string& value) { return toml_string(value); }

std::string list_text(const std::vector<double>& numbers) {
  std::string text;
  for (const double x : numbers) text += (text.empty() ? "" : ", ") + toml_text(x);
  return "[" + text + "]";
}

/// Writes { a = "b", c = "d" }.
class InlineTable {
 public:
  void add(const std::string& key, const std::string& value) {
    text_ += (text_.empty() ? "" : ", ") + toml_key(key) + " = " + value;
  }
  std::string text() const { return "{ " + text_ + " }"; }

 private:
  std::string text_;
};

std::string table_text(const std::map<std::string, std::string>& texts) {
  InlineTable table;
  for (const auto& [key, value] : texts) table.add(key, toml_text(value));
  return table.text();
}

struct ToToml {
  template <class Value>
  std::string operator()(const Value* value) const {
    return toml_text(*value);
  }
  template <class Value>
  std::string operator()(const std::optional<Value>* value) const {
    return *value ? toml_text(**value) : "";
  }
  std::string operator()(const std::vector<std::string>* values) const {
    std::string text;
    for (const std::string& one : *values) text += (text.empty() ? "" : ", ") + toml_text(one);
    return "[" + text + "]";
  }
};

/// The options whose values differ from the defaults.
template <class Options>
std::string fields_text(Options options) {
  Options standard;
  const Fields fields = describe(options), defaults = describe(standard);
  std::string text;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string value = std::visit(ToToml{}, fields[i].value);
    if (value == std::visit(ToToml{}, defaults[i].value)) continue;
    text += fmt::format("{} = {}\n", fields[i].name, value);
  }
  return text;
}

/// The tables of one stream.
std::string stream_text(const StreamOptions& stream) {
  std::string text = fmt::format("\n[stream.{}]\n", toml_key(stream.name));
  if (!stream.files.empty()) text += files_toml(stream.files) + "\n";
  text += fields_text(stream);
  if (!stream.select.empty()) text += select_toml(stream.select) + "\n";
  if (stream.mounting.empty()) return text;
  text += fmt::format("\n[stream.{}.mounting]\n", toml_key(stream.name));
  for (const auto& [node, rotation] : stream.mounting) {
    text += toml_key(node) + " = " + list_text(rotation) + "\n";
  }
  return text;
}

std::string space_text(const std::string& stream, const SpaceOptions& space) {
  std::string text = fmt::format("\n[space.{}]\n", toml_key(stream)) + fields_text(space);
  if (!space.joints.empty()) text += "joints = " + table_text(space.joints) + "\n";
  if (!space.rotation.empty()) text += "rotation = " + list_text(space.rotation) + "\n";
  if (!space.translation.empty()) text += "translation = " + list_text(space.translation) + "\n";
  return text;
}

}  // namespace

std::string files_toml(const std::vector<StreamFile>& files) {
  if (files.empty()) return "files = []";
  if (files.size() == 1 && files.front().node.empty()) {
    return "file = " + toml_text(files.front().path);
  }
  if (files.front().node.empty()) {
    std::string list;
    for (const StreamFile& file : files) list += (list.empty() ? "" : ", ") + toml_text(file.path);
    return "files = [" + list + "]";
  }
  InlineTable table;
  for (const StreamFile& file : files) table.add(file.node, toml_text(file.path));
  return "files = " + table.text();
}

std::string select_toml(const std::map<std::string, std::string>& select) {
  return "select = " + table_text(select);
}

std::string manifest_toml(const Manifest& manifest) {
  std::string text;
  if (!manifest.subject.empty()) text += "subject = " + toml_text(manifest.subject) + "\n";
  if (!manifest.action.empty()) text += "action = " + toml_text(manifest.action) + "\n";
  if (const std::string align = fields_text(manifest.align); !align.empty()) {
    text += "\n[align]\n" + align;
  }
  for (const StreamOptions& stream : manifest.streams) text += stream_text(stream);
  for (const auto& [stream, space] : manifest.spaces) text += space_text(stream, space);
  return text;
}

}  // namespace kinalign
