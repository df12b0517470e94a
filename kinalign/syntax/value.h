// SPDX-License-Identifier: Apache-2.0
// A value of a TOML or JSON text. Options (core/options.h) are set from such values, so both
// formats share one check and one message.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

/// `scalar` contains the value of a truth, whole, number or text. A list or a table has `items`
/// instead.
struct Value {
  enum class Kind { null, truth, whole, number, text, date, list, table };

  Kind kind = Kind::null;
  std::variant<bool, std::int64_t, double, std::string> scalar;  // not used by null and date
  std::vector<Value> items;  // of a list or a table; a table's entries keep the file's order
  std::string key;           // the key, if the value stands in a table
  std::string path;          // the keys from the top: "stream.mocap.gap_ms", "streams[0].gap_ms"
  std::int64_t line = 0;     // counted from 1; 0 for JSON

  bool is_table() const { return kind == Kind::table; }
  /// Sets a value of the kind truth, whole, number or text.
  void set(Kind new_kind, auto value) {
    kind = new_kind;
    scalar = std::move(value);
  }
  /// The name in messages: the key if the line is known, else the path.
  const std::string& name() const { return line > 0 ? key : path; }
  /// The value that these keys lead to; nullptr if there is none.
  const Value* find(std::initializer_list<std::string_view> keys) const;
};

/// An error at the value's line. A Value does not know its file, so the reader of the file adds the
/// file's name.
Failure at(const Value& value, Error error);
inline Failure at(const Value& value, std::string expected, std::string found) {
  return at(value, Error{"", 0, std::move(expected), std::move(found)});
}
/// The failure for a value of a wrong form: "expected gap_ms as a number, found "3"".
Failure wrong(const Value& value, const std::string& wanted);
/// The value in a few words for messages, for example "-1", a text in quotes, or "a table".
std::string shown(const Value& value);

Result<std::string> text_of(const Value& value);
/// The entries of a table; fails for any other value.
Result<std::span<const Value>> entries_of(const Value& value);

/// Sets the option. Fails if the value has another type, or is outside the range or the choices.
Result<void> set_option(const Field& field, const Value& value);

/// For keys that are not options, such as those of inner tables: the function that reads the value.
using OtherKeys = std::map<std::string, std::function<Result<void>(const Value&)>>;

/// Sets options from the entries of a table. A key that is neither an option nor in `others` is
/// refused, and the message suggests the nearest known key. Entries are read in the order of the
/// file, so the first fault in the file is reported.
Result<void> read_options(const Value& table, const Fields& fields, const OtherKeys& others = {});

}  // namespace kinalign
