// SPDX-License-Identifier: Apache-2.0
#include "kinalign/syntax/value.h"

#include "kinalign/core/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace kinalign {

namespace {

using Kind = Value::Kind;

/// Sets an option from a value. There is one operator() for each type of option, and std::visit
/// chooses among them. Each one checks kind and range, and its error names the expected form.
class Setter {
 public:
  Setter(const Field& field, const Value& value) : field_(field), value_(value) {}

  Result<void> operator()(bool* to) const {
    if (value_.kind != Kind::truth) return wrong(value_, "true or false");
    *to = std::get<bool>(value_.scalar);
    return {};
  }
  Result<void> operator()(double* to) const {
    const auto number = number_in(value_);
    if (!number) return wrong(value_, ranged("a number"));
    *to = *number;
    return {};
  }
  /// 3.0 is not accepted as a whole number, because the point makes it a number of another kind.
  Result<void> operator()(std::int64_t* to) const {
    if (value_.kind != Kind::whole || !number_in(value_)) {
      return wrong(value_, ranged("a whole number"));
    }
    *to = std::get<std::int64_t>(value_.scalar);
    return {};
  }
  Result<void> operator()(std::string* to) const {
    const auto* text = std::get_if<std::string>(&value_.scalar);
    const auto& choices = field_.choices;
    const bool known =
        text != nullptr &&
        (choices.empty() || std::find(choices.begin(), choices.end(), *text) != choices.end());
    if (!known) return wrong(value_, choices.empty() ? "a text" : one_of_choices());
    *to = *text;
    return {};
  }
  /// In JSON, null leaves out an optional value. TOML has no null.
  template <class Number>
  Result<void> operator()(std::optional<Number>* to) const {
    if (value_.kind == Kind::null) return {};
    return (*this)(&to->emplace());
  }
  Result<void> operator()(std::vector<std::string>* to) const {
    if (value_.kind != Kind::list) return wrong(value_, "a list of texts");
    for (const Value& one : value_.items) {
      if (one.kind != Kind::text) return wrong(value_, "a list of texts");
      to->push_back(std::get<std::string>(one.scalar));
    }
    return {};
  }
  /// The JSON in a take writes an absent list as an empty list.
  Result<void> operator()(std::vector<double>* to) const {
    if (value_.line == 0 && value_.kind == Kind::list && value_.items.empty()) return {};
    *to = KA_TRY(numbers());
    return {};
  }
  /// A whole number is converted to its text, as in { "Skeleton#" = 0 }.
  Result<void> operator()(std::map<std::string, std::string>* to) const {
    for (const Value& one : KA_TRY(entries_of(value_))) {
      if (one.kind == Kind::whole) {
        (*to)[one.key] = std::to_string(std::get<std::int64_t>(one.scalar));
      } else {
        KA_TRY(Setter(field_, one)(&(*to)[one.key]));
      }
    }
    return {};
  }
  Result<void> operator()(std::map<std::string, double>* to) const {
    for (const Value& one : KA_TRY(entries_of(value_))) {
      KA_TRY(Setter(field_, one)(&(*to)[one.key]));
    }
    return {};
  }
  Result<void> operator()(std::map<std::string, std::vector<double>>* to) const {
    for (const Value& one : KA_TRY(entries_of(value_))) {
      (*to)[one.key] = KA_TRY(Setter(field_, one).numbers());
    }
    return {};
  }

 private:
  /// The number if `value` is a number within the range; otherwise empty.
  std::optional<double> number_in(const Value& value) const {
    // Integers are accepted as numbers, so "gap_ms = 200" needs no point.
    const auto* whole = std::get_if<std::int64_t>(&value.scalar);
    const auto* number = std::get_if<double>(&value.scalar);
    if (whole == nullptr && number == nullptr) return std::nullopt;
    const double x = whole != nullptr ? static_cast<double>(*whole) : *number;
    if (!std::isfinite(x) || x < field_.least || x > field_.most) return std::nullopt;
    return x;
  }

  /// The numbers of a list. A single number is accepted if the option allows any count. An error
  /// names the line of the faulty number, which may be below the line of the list's key.
  Result<std::vector<double>> numbers() const {
    const std::string wanted = field_.count == 0
                                   ? ranged("a number or a list of numbers")
                                   : fmt::format("a list of {} numbers", field_.count);
    const bool single = field_.count == 0 && value_.kind != Kind::list;
    const std::span<const Value> all = single ? std::span(&value_, 1) : std::span(value_.items);
    if (!single && value_.kind != Kind::list) return wrong(value_, wanted);
    std::vector<double> out;
    for (const Value& one : all) {
      const auto number = number_in(one);
      if (!number) return at(one, value_.name() + " as " + wanted, shown(one));
      out.push_back(*number);
    }
    if (field_.count != 0 && out.size() != field_.count) {
      return at(value_, value_.name() + " as " + wanted, fmt::format("{} numbers", out.size()));
    }
    // A list of four numbers is a rotation. Zeros or degrees have a length far from 1 and are
    // refused.
    if (field_.count == 4) KA_TRY(check_rotation(out));
    return out;
  }

  Result<void> check_rotation(const std::vector<double>& q) const {
    const double length = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
    if (length >= 0.5 && length <= 2.0) return {};
    return at(value_, value_.name() + " as w,x,y,z of a length from 0.5 to 2",
              fmt::format("a length of {:.6g}", length));
  }

  /// If an option has no lower limit, the message names no range, even if there is an upper limit.
  std::string ranged(const std::string& kind) const {
    if (!(field_.least > -unlimited)) return kind;
    return fmt::format("{} from {} to {}", kind, field_.least, field_.most);
  }
  std::string one_of_choices() const {
    std::string list;
    for (const std::string& choice : field_.choices) {
      list += (list.empty() ? "" : ", ") + (choice.empty() ? "\"\"" : choice);
    }
    return "one of " + list;
  }

  const Field& field_;
  const Value& value_;
};

}  // namespace

const Value* Value::find(std::initializer_list<std::string_view> keys) const {
  // Only tables have keys. The values of a list repeat the key of the list.
  const Value* found = this;
  for (const std::string_view wanted : keys) {
    if (!found->is_table()) return nullptr;
    const auto one = std::find_if(found->items.begin(), found->items.end(),
                                  [&](const Value& item) { return item.key == wanted; });
    if (one == found->items.end()) return nullptr;
    found = &*one;
  }
  return found;
}

Failure at(const Value& value, Error error) {
  error.line = value.line;
  return Failure(std::move(error));
}

Failure wrong(const Value& value, const std::string& wanted) {
  return at(value, value.name() + " as " + wanted, shown(value));
}

std::string shown(const Value& value) {
  switch (value.kind) {
    case Kind::null:
      return "null";
    case Kind::date:
      return "a date or time";
    case Kind::list:
      return "a list";
    case Kind::table:
      return "a table";
    case Kind::text:
      return "\"" + shown(std::get<std::string>(value.scalar)) + "\"";
    // The remaining kinds contain a number or a truth value.
    default:
      return std::visit([](const auto& scalar) { return fmt::format("{}", scalar); }, value.scalar);
  }
}

Result<std::string> text_of(const Value& value) {
  // The option has neither choices nor a range, so only the kind is checked.
  std::string text;
  KA_TRY(set_option({"", "", &text}, value));
  return text;
}

Result<std::span<const Value>> entries_of(const Value& value) {
  if (!value.is_table()) return wrong(value, "a table");
  return std::span(value.items);
}

Result<void> set_option(const Field& field, const Value& value) {
  return std::visit(Setter(field, value), field.value);
}

Result<void> read_options(const Value& table, const Fields& fields, const OtherKeys& others) {
  // The entries are visited in the order of the file, so the first fault of the file is reported.
  for (const Value& entry : KA_TRY(entries_of(table))) {
    if (const auto other = others.find(entry.key); other != others.end()) {
      KA_TRY(other->second(entry));
      continue;
    }
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const Field& one) { return one.name == entry.key; });
    if (field != fields.end()) {
      KA_TRY(set_option(*field, entry));
      continue;
    }
    // The error suggests the nearest key among all accepted keys.
    std::vector<std::string> known;
    for (const auto& [key, read] : others) known.push_back(key);
    for (const Field& one : fields) known.push_back(one.name);
    const std::string place = table.path.empty() ? "a known key" : "a key of [" + table.path + "]";
    return at(entry, unknown_name(entry.key, place, known));
  }
  return {};
}

}  // namespace kinalign
