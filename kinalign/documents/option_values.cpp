// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace kinalign {

namespace {

std::string written(const OptionValue& value) {
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return "\"" + shown(*text) + "\"";
  return "a list";
}

/// The allowed values of an option, in words.
std::string wanted(const Field& field, const char* kind) {
  if (!field.choices.empty()) {
    std::string list;
    for (const std::string& choice : field.choices) {
      list += (list.empty() ? "" : ", ") + (choice.empty() ? "\"\"" : choice);
    }
    return field.name + " as one of " + list;
  }
  if (field.least > -unlimited) {
    return fmt::format("{} as {} from {} to {}", field.name, kind, field.least, field.most);
  }
  return field.name + " as " + kind;
}

std::optional<double> number_in(const OptionValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

std::optional<std::int64_t> whole_in(const OptionValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
  return std::nullopt;
}

template <class Value>
std::optional<Value> same_in(const OptionValue& value) {
  if (const auto* same = std::get_if<Value>(&value)) return *same;
  return std::nullopt;
}

/// For each kind of option: its name in messages, and whether the value is of that kind.
struct Kind {
  const char* name;
  bool fits;
};

struct Assigner {
  const Field& field;
  const OptionValue& value;

  template <class Target, class Value>
  Kind put(const char* name, Target* target, const std::optional<Value>& found) const {
    if (!found) return {name, false};
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
      const auto number = static_cast<double>(*found);
      if (!std::isfinite(number) || number < field.least || number > field.most) {
        return {name, false};
      }
    }
    if constexpr (std::is_same_v<Value, std::string>) {
      const auto& choices = field.choices;
      if (!choices.empty() && std::find(choices.begin(), choices.end(), *found) == choices.end()) {
        return {name, false};
      }
    }
    *target = *found;
    return {name, true};
  }

  Kind operator()(bool* to) const { return put("true or false", to, same_in<bool>(value)); }
  Kind operator()(double* to) const { return put("a number", to, number_in(value)); }
  Kind operator()(std::optional<double>* to) const { return put("a number", to, number_in(value)); }
  Kind operator()(std::int64_t* to) const { return put("a whole number", to, whole_in(value)); }
  Kind operator()(std::optional<std::int64_t>* to) const {
    return put("a whole number", to, whole_in(value));
  }
  Kind operator()(std::string* to) const { return put("a text", to, same_in<std::string>(value)); }
  Kind operator()(std::vector<std::string>* to) const {
    return put("a list of texts", to, same_in<std::vector<std::string>>(value));
  }
};

}  // namespace

Result<void> assign(const Field& field, const OptionValue& value) {
  const Kind kind = std::visit(Assigner{field, value}, field.value);
  if (kind.fits) return {};
  return Failure(Error{"", 0, wanted(field, kind.name), written(value)});
}

Result<void> check_rotation(const std::string& name, std::span<const double> numbers) {
  const std::string expected = name + " as w,x,y,z of a length from 0.5 to 2";
  if (numbers.size() != 4) {
    return Failure(Error{"", 0, expected, fmt::format("{} numbers", numbers.size())});
  }
  const double length =
      std::sqrt(std::inner_product(numbers.begin(), numbers.end(), numbers.begin(), 0.0));
  if (length >= 0.5 && length <= 2.0) return {};
  return Failure(Error{"", 0, expected, fmt::format("a length of {:.6g}", length)});
}

const Field* find_field(const Fields& fields, std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const Field& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace kinalign
