// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/layout_keys.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace kinalign {

struct LayoutKeys::Document {
  std::string file;
  toml::table root;
};

namespace {

const toml::table& as_table(const void* table) { return *static_cast<const toml::table*>(table); }

std::int64_t line_of(const toml::source_region& region) {
  return static_cast<std::int64_t>(region.begin.line);
}

/// Text of a value for messages.
std::string as_text(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  std::ostringstream out;
  node.visit([&out](const auto& value) {
    if constexpr (!toml::is_table<decltype(value)> && !toml::is_array<decltype(value)>)
      out << value;
  });
  std::string text = out.str();
  if (node.is_table()) text = "a table";
  if (node.is_array()) text = "an array";
  return text;
}

std::string list_of(const LayoutKeys::Names& names) {
  std::string list;
  for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

}  // namespace

LayoutKeys::LayoutKeys(std::shared_ptr<const Document> document, const void* table)
    : document_(std::move(document)), table_(table) {}

Result<LayoutKeys> LayoutKeys::parse(std::string_view toml, std::string_view file,
                                     const Names& known) {
  auto document = std::make_shared<Document>();
  document->file = file;
  try {
    document->root = toml::parse(toml);
  } catch (const toml::parse_error& fault) {
    return Failure(Error{std::string(file), line_of(fault.source()), "TOML",
                         std::string(fault.description())});
  }
  const toml::table* root = &document->root;
  LayoutKeys keys(std::move(document), root);
  KA_TRY(keys.check_known(known));
  return keys;
}

Result<void> LayoutKeys::check_known(const Names& known) const {
  for (const auto& [key, value] : as_table(table_)) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    return Failure(Error{document_->file, line_of(key.source()),
                         "one of the keys " + list_of(known), shown(key.str())});
  }
  return {};
}

Result<LayoutKeys> LayoutKeys::table(std::string_view key, const Names& known) const {
  const toml::table* inner = as_table(table_)[key].as_table();
  if (inner == nullptr) return wrong(key, "a table [" + std::string(key) + "]");
  LayoutKeys keys(document_, inner);
  if (!known.empty()) KA_TRY(keys.check_known(known));
  return keys;
}

bool LayoutKeys::has(std::string_view key) const { return as_table(table_).contains(key); }
bool LayoutKeys::is_table(std::string_view key) const { return as_table(table_)[key].is_table(); }
bool LayoutKeys::is_text(std::string_view key) const { return as_table(table_)[key].is_string(); }

std::vector<std::string> LayoutKeys::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : as_table(table_)) names.emplace_back(key.str());
  return names;
}

Result<std::string> LayoutKeys::text(std::string_view key) const {
  const auto node = as_table(table_)[key];
  if (const auto* text = node.as_string()) return text->get();
  if (node.is_number()) return as_text(*node.node());
  return wrong(key, std::string(key) + " = a text");
}

Result<std::string> LayoutKeys::text(std::string_view key, std::string_view otherwise) const {
  if (!has(key)) return std::string(otherwise);
  return text(key);
}

Result<bool> LayoutKeys::truth(std::string_view key, bool otherwise) const {
  if (!has(key)) return otherwise;
  if (const auto* truth = as_table(table_)[key].as_boolean()) return truth->get();
  return wrong(key, std::string(key) + " = true or false");
}

Result<std::size_t> LayoutKeys::count(std::string_view key, std::size_t otherwise) const {
  constexpr std::int64_t most = 100'000;
  if (!has(key)) return otherwise;
  const auto* number = as_table(table_)[key].as_integer();
  if (number != nullptr && number->get() >= 0 && number->get() <= most) {
    return static_cast<std::size_t>(number->get());
  }
  return wrong(key, std::string(key) + " = a whole number up to " + std::to_string(most));
}

Result<double> LayoutKeys::positive(std::string_view key, double otherwise) const {
  if (!has(key)) return otherwise;
  const auto node = as_table(table_)[key];
  if (const auto number = node.value<double>(); node.is_number() && number) {
    if (*number >= 1e-9 && *number <= 1e9) return *number;
  }
  return wrong(key, std::string(key) + " = a number from 1e-9 to 1e9");
}

Result<std::vector<double>> LayoutKeys::numbers(std::string_view key) const {
  const auto node = as_table(table_)[key];
  std::vector<double> numbers;
  const auto take = [&numbers](const toml::node& each) {
    const auto number = each.value<double>();
    if (!each.is_number() || !number || !std::isfinite(*number)) return false;
    numbers.push_back(*number);
    return true;
  };
  bool good = node.node() != nullptr;
  if (const auto* array = node.as_array()) {
    good = std::all_of(array->begin(), array->end(), take);
  } else if (good) {
    good = take(*node.node());
  }
  if (!good) return wrong(key, std::string(key) + " = a number or several in brackets");
  return numbers;
}

Result<std::vector<std::string>> LayoutKeys::texts(std::string_view key) const {
  std::vector<std::string> texts;
  const auto* array = as_table(table_)[key].as_array();
  if (array == nullptr || array->empty()) return wrong(key, std::string(key) + " = several texts");
  for (const toml::node& each : *array) {
    const auto* text = each.as_string();
    if (text == nullptr) return wrong(key, std::string(key) + " = several texts");
    texts.push_back(text->get());
  }
  return texts;
}

Error LayoutKeys::error(std::string_view key, std::string expected, std::string found) const {
  const toml::node* node = as_table(table_).get(key);
  const auto& region = node != nullptr ? node->source() : as_table(table_).source();
  return {document_->file, std::max<std::int64_t>(line_of(region), 1), std::move(expected),
          std::move(found)};
}

Failure LayoutKeys::wrong(std::string_view key, std::string expected) const {
  const toml::node* node = as_table(table_).get(key);
  return Failure(
      error(key, std::move(expected), node != nullptr ? shown(as_text(*node)) : "nothing"));
}

}  // namespace kinalign
