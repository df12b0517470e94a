// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/field_text.h"

#include "kinalign/core/numbers.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace kinalign {

namespace {

template <class... Kinds>
struct Overloaded : Kinds... {
  using Kinds::operator()...;
};
template <class... Kinds>
Overloaded(Kinds...) -> Overloaded<Kinds...>;  // clang 14 needs this guide

/// The shortest text that set_field() reads as exactly the same number.
std::string text_of(double number) {
  std::array<char, number_room> room{};
  const char* end = std::to_chars(room.data(), room.data() + room.size(), number).ptr;
  return {room.data(), static_cast<std::size_t>(end - room.data())};
}

Failure instead_of(std::string expected, std::string_view text) {
  return Failure(Error{"", 0, std::move(expected), text.empty() ? "nothing" : shown(text)});
}

std::string range_of(const Field& field) {
  const bool above = field.least > -unlimited;
  const bool below = field.most < unlimited;
  if (above && below) return " from " + text_of(field.least) + " to " + text_of(field.most);
  if (above) return " of at least " + text_of(field.least);
  if (below) return " of at most " + text_of(field.most);
  return "";
}

Result<double> number_in(const Field& field, std::string_view text) {
  double value = 0.0;
  if (!parse_number(text, value) || value < field.least || value > field.most) {
    return instead_of("a number" + range_of(field), text);
  }
  return value;
}

/// Parses a whole number within the option's range. Ranges are stored as double for all kinds of
/// number.
Result<std::int64_t> integer_in(const Field& field, std::string_view text) {
  std::int64_t value = 0;
  const bool is_whole = parse_integer(text, value);
  const auto near = static_cast<double>(value);
  if (!is_whole || near < field.least || near > field.most) {
    return instead_of("a whole number" + range_of(field), text);
  }
  return value;
}

/// Parses the words for true and false that people write in files and variables.
Result<bool> truth_in(std::string_view text) {
  if (text == "true" || text == "1" || text == "yes") return true;
  if (text == "false" || text == "0" || text == "no") return false;
  return instead_of("true or false", text);
}

Result<std::string> string_in(const Field& field, std::string_view text) {
  const auto& choices = field.choices;
  if (choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end()) {
    return std::string(text);
  }
  return instead_of(any_of(choices), text);
}

std::string capitals(std::string_view name) {
  std::string out;
  for (const char c : name) out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return out;
}

}  // namespace

Result<void> set_field(const Field& field, std::string_view text) {
  const Overloaded set{
      [&](bool* at) -> Result<void> { return truth_in(text).map([&](bool v) { *at = v; }); },
      [&](double* at) -> Result<void> {
        return number_in(field, text).map([&](double v) { *at = v; });
      },
      [&](std::optional<double>* at) -> Result<void> {
        return number_in(field, text).map([&](double v) { *at = v; });
      },
      [&](std::int64_t* at) -> Result<void> {
        return integer_in(field, text).map([&](std::int64_t v) { *at = v; });
      },
      [&](std::optional<std::int64_t>* at) -> Result<void> {
        return integer_in(field, text).map([&](std::int64_t v) { *at = v; });
      },
      [&](std::string* at) -> Result<void> {
        return string_in(field, text).map([&](std::string v) { *at = std::move(v); });
      },
      [&](std::vector<std::string>* at) -> Result<void> {
        return string_in(field, text).map([&](std::string v) { at->push_back(std::move(v)); });
      },
      // Only files can set tables and lists of numbers.
      [&](auto*) -> Result<void> { return instead_of("an option that has a flag", field.name); },
  };
  return std::visit(set, field.value);
}

std::string field_text(const Field& field) {
  const Overloaded text{
      [](const bool* at) { return std::string(*at ? "true" : "false"); },
      [](const double* at) { return text_of(*at); },
      [](const std::optional<double>* at) { return *at ? text_of(**at) : std::string(); },
      [](const std::int64_t* at) { return std::to_string(*at); },
      [](const std::optional<std::int64_t>* at) {
        return *at ? std::to_string(**at) : std::string();
      },
      [](const std::string* at) { return *at; },
      [](const std::vector<std::string>* at) {
        std::string all;
        for (const std::string& one : *at) all += (all.empty() ? "" : ", ") + one;
        return all;
      },
      [](const auto*) { return std::string(); },  // only files can set a table or a list of numbers
  };
  return std::visit(text, field.value);
}

bool is_switch(const Field& field) { return std::holds_alternative<bool*>(field.value); }

std::string placeholder(const Field& field) {
  if (is_switch(field)) return "";
  if (!field.stands_for.empty()) return field.stands_for;
  // An empty choice stands for the default and is not shown.
  std::string choices;
  for (const std::string& choice : field.choices) {
    if (!choice.empty()) choices += (choices.empty() ? "" : "|") + choice;
  }
  if (!choices.empty()) return choices;
  if (field.name.ends_with("layout")) return "LAYOUT";
  // The word for an option's value in the help page, where TEXT or NUMBER would say too little. A
  // field may also state its own word.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 27> names{
      {{"out", "FILE"},         {"config", "FILE"},       {"mocap", "FILE"},
       {"kinect", "FILE"},      {"inputs", "FOLDER"},     {"imu", "NODE=FILE"},
       {"points", "NAME=FILE"}, {"joint", "JOINT=JOINT"}, {"select", "COLUMN=VALUE"},
       {"root_node", "NODE"},   {"reference", "STREAM"},  {"listen", "ADDRESS"},
       {"exempt", "NETWORK"},   {"port", "PORT"},         {"node_port", "PORT"},
       {"lab_key", "FILE"},     {"new_lab_key", "FILE"},  {"node", "ID"},
       {"subject", "NAME"},     {"action", "NAME"},       {"device", "NAME=PROTOCOL:PORT"},
       {"marks_port", "PORT"},  {"trigger_port", "PORT"}, {"to", "ADDRESS"},
       {"mocap_port", "PORT"},  {"kinect_port", "PORT"},  {"skeleton", "FILE"}}};
  for (const auto& [name, shown_as] : names) {
    if (field.name == name) return std::string(shown_as);
  }
  const bool text = std::holds_alternative<std::string*>(field.value) ||
                    std::holds_alternative<std::vector<std::string>*>(field.value);
  return text ? "TEXT" : "NUMBER";
}

std::string flag_of(std::string_view name) {
  std::string flag = "--" + std::string(name);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

std::string variable_of(std::string_view name) { return "KINALIGN_" + capitals(name); }

std::string any_of(const std::vector<std::string>& words) {
  // An empty choice stands for the default and is not shown.
  std::vector<std::string> known = words;
  std::erase(known, "");
  std::string text;
  for (std::size_t i = 0; i < known.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == known.size() ? " or " : ", ") + known[i];
  }
  return text;
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> out{""};
  for (const char c : text) {
    if (c == ',') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

}  // namespace kinalign
