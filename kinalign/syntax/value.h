// SPDX-License-Identifier: Apache-2.0
// A value of a TOML or JSON text, and options (core/options.h) set from it: one check and one
// message for both.
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

/// `scalar` holds the value of the four simple kinds. A list or a table has `items` instead.
struct Value {
  enum class Kind { null, truth, whole, number, text, date, list, table };

  Kind kind = Kind::null;
  std::variant<bool, std::int64_t, double, std::string> scalar;  // neither null nor a date
  std::vector<Value> items;  // of a list or a table; a table's are in the order of the file
  std::string key;           // in a table
  std::string path;          // from the top: "stream.mocap.gap_ms", "streams[0].gap_ms"
  std::int64_t line = 0;     // 0: JSON

  bool is_table() const { return kind == Kind::table; }
  /// Makes this a value of a simple kind.
  void set(Kind new_kind, auto value) {
    kind = new_kind;
    scalar = std::move(value);
  }
  /// The name in messages: the key if the line tells the place, else the path.
  const std::string& name() const { return line > 0 ? key : path; }
  /// The value below these keys; nullptr if there is none.
  const Value* find(std::initializer_list<std::string_view> keys) const;
};

/// An error at the value's line. The file's name is added by the reader of the file.
/// It has no file yet, because a Value does not know from which file it came.
Failure at(const Value& value, Error error);
inline Failure at(const Value& value, std::string expected, std::string found) {
  return at(value, std::move(expected), std::move(found));
}
/// "expected gap_ms as a number, found "3"".
Failure wrong(const Value& value, const std::string& wanted);
/// The value in a few words: "-1", a text in quotes, "a table".
std::string shown(const Value& value);

Result<std::string> text_of(const Value& value);
/// The entries of a table; fails for any other value.
Result<std::span<const Value>> entries_of(const Value& value);

/// Sets the option. Fails if the value has another type, or is outside the range or the choices.
Result<void> set_option(const Field& field, const Value& value);

/// Readers of the keys that are no options, such as inner tables.
using OtherKeys = std::map<std::string, std::function<Result<void>(const Value&)>>;

/// Sets options from the entries of a table. A key that is neither an option nor in `others` is
/// refused with the nearest known key.
/// A reader is called at its key's place in the file, so faults are found in the order of the
/// lines.
Result<void> read_options(const Value& table, const Fields& fields, const OtherKeys& others = {});

}  // namespace kinalign
