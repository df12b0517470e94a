// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/table_columns.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/core/numbers.h"
#include "kinalign/core/utf8.h"

#include <algorithm>

namespace kinalign {

namespace {

using enum TableField;

/// A quantity: its fields in the order of their slots, and the member that stores its first slot.
/// needed: true for positions, because a table of points has no meaning without them.
struct Quantity {
  std::vector<TableField> fields;
  int TableColumns::*first;
  bool needed;
};

std::vector<Quantity> quantities() {
  return {{{x, y, z}, &TableColumns::positions, true},
          {{state}, &TableColumns::states, false},
          {{qw, qx, qy, qz}, &TableColumns::orientation, false},
          {{ax, ay, az}, &TableColumns::acceleration, false},
          {{gx, gy, gz}, &TableColumns::angular_velocity, false}};
}

// The pattern may contain the placeholder more than once.
std::string with_member(std::string pattern, const std::string& member) {
  for (const std::string_view place : {"{joint}", "{node}"}) {
    for (auto at = pattern.find(place); at != std::string::npos;
         at = pattern.find(place, at + member.size())) {
      pattern.replace(at, place.size(), member);
    }
  }
  return pattern;
}

/// Finds columns by name, and assigns slots and texts of RowParser to them.
class Finder {
 public:
  Finder(const TableLayout& layout, const std::vector<std::string>& members,
         const std::vector<std::string>& names)
      : layout_(layout), members_(members), named_(!names.empty()) {
    // `times` counts how often a name occurs. The first column of each name is kept.
    for (std::size_t i = 0; i < names.size(); ++i)
      ++places_.try_emplace(as_utf8(names[i]), i).first->second.times;
    found_.uses.resize(named_ ? names.size() : layout.columns);
  }

  /// Quantities get their slots first, so that these slots are consecutive from 0.
  Result<TableColumns> find(const std::map<std::string, std::string>& select) {
    for (const Quantity& quantity : quantities()) KA_TRY(place(quantity));
    if (layout_.time) {
      found_.time_text = static_cast<int>(text_of(KA_TRY(column_of(layout_.time->column))));
    }
    for (const auto& [column, value] : select) {
      found_.choices.push_back({column, text_of(KA_TRY(selected(column))), value});
    }
    // A file without the column of the body has a single body.
    if (places_.contains(layout_.body)) {
      found_.body = {layout_.body, text_of(KA_TRY(column_of({layout_.body, 0}))), ""};
    }
    if (slots_ == 0) return refuse("columns of layout " + layout_.name, "none");
    // Counts the columns that are not used. One of them may have a misspelt name.
    found_.unread = static_cast<std::size_t>(
        std::count_if(found_.uses.begin(), found_.uses.end(),
                      [](const ColumnUse& use) { return use.slot < 0 && use.text < 0; }));
    return std::move(found_);
  }

 private:
  /// The first column with a name, and the number of columns with this name. A name that occurs
  /// twice is an error only if it is used.
  struct Place {
    explicit Place(std::size_t i) : column(i) {}
    std::size_t column;
    int times = 0;
  };

  std::vector<std::string> known() const {
    std::vector<std::string> names;
    for (const auto& [name, place] : places_) names.push_back(name);
    return names;
  }

  /// The error for an absent column. It suggests the most similar name.
  Failure no_column(const std::string& name) const {
    const std::string near = nearest_name(name, known());
    const std::string hint = near.empty() ? "" : " (nearest: " + shown(near) + ")";
    return refuse("a column " + shown(name), "no such column" + hint);
  }

  /// The column of a condition: its name or, if the file has no such name, its number.
  ColumnChoice choice_of(const std::string& column) const {
    // If a column has the name "3", the name has priority over the number.
    std::size_t number = 0;
    if (!places_.contains(column) && parse_integer(column, number)) return {"", number};
    return {column, 0};
  }

  /// The index of the chosen column. Its name must occur exactly once in the file.
  Result<std::size_t> column_of(const ColumnChoice& choice) const {
    if (choice.number != 0) {
      if (choice.number <= found_.uses.size()) return choice.number - 1;
      return refuse("a column " + std::to_string(choice.number),
                    std::to_string(found_.uses.size()) + " columns");
    }
    const auto place = places_.find(choice.name);
    if (place == places_.end()) return no_column(choice.name);
    if (place->second.times == 1) return place->second.column;
    return refuse("one column " + shown(choice.name),
                  std::to_string(place->second.times) + " with this name");
  }

  Result<std::size_t> selected(const std::string& column) const {
    const ColumnChoice choice = choice_of(column);
    if (choice.number != 0 || !named_ || places_.contains(column)) return column_of(choice);
    return Failure(unknown_name(column, "an existing column in select", known()));
  }

  /// The columns of a quantity: for each member (joint or node) all fields. This order gives [M,3],
  /// as in kinalign's arrays. `missing` is set to the first name that the file lacks.
  Result<std::vector<std::size_t>> columns_of(const Quantity& quantity,
                                              std::string& missing) const {
    std::vector<std::size_t> columns;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      for (const TableField field : quantity.fields) {
        const auto at = std::find_if(layout_.fields.begin(), layout_.fields.end(),
                                     [&](const FieldColumn& each) { return each.field == field; });
        // The layout does not contain this quantity.
        if (at == layout_.fields.end()) return columns;
        const auto i = static_cast<std::size_t>(at - layout_.fields.begin());
        const std::string name = with_member(at->pattern, members_[m]);
        ColumnChoice choice{name, 0};
        if (!layout_.by_name) {
          // Without names, the columns of one joint or node follow each other.
          choice.number = layout_.first_column + m * layout_.fields.size() + i;
        } else if (!places_.contains(name)) {
          // The name is kept for a message. The search goes on, because other columns may exist.
          if (missing.empty()) missing = name;
          continue;
        }
        columns.push_back(KA_TRY(column_of(choice)));
      }
    }
    return columns;
  }

  /// Gives the columns of a quantity consecutive slots. A column may belong to one quantity only.
  Result<void> place(const Quantity& quantity) {
    std::string missing;
    const auto columns = KA_TRY(columns_of(quantity, missing));
    // It is an error if a needed quantity is missing, or if only a part of a quantity exists.
    if (!missing.empty() && (quantity.needed || !columns.empty())) return no_column(missing);
    if (!missing.empty()) found_.absent.push_back(missing);
    if (columns.empty()) return {};
    found_.*quantity.first = slots_;
    for (const std::size_t column : columns) {
      // A column can't belong to two quantities.
      if (found_.uses[column].slot >= 0) {
        return refuse("one use of column " + std::to_string(column + 1), "two");
      }
      found_.uses[column].slot = slots_++;
    }
    return {};
  }

  std::size_t text_of(std::size_t column) {
    int& text = found_.uses[column].text;
    // A column may be read as text and as number, such as the time or a number in a condition.
    if (text < 0) text = texts_++;
    return static_cast<std::size_t>(text);
  }

  const TableLayout& layout_;
  const std::vector<std::string>& members_;
  bool named_;
  std::map<std::string, Place> places_;
  TableColumns found_;
  int slots_ = 0, texts_ = 0;
};

}  // namespace

Result<TableColumns> find_columns(const TableLayout& layout,
                                  const std::vector<std::string>& members,
                                  const std::map<std::string, std::string>& select,
                                  const std::vector<std::string>& names) {
  return Finder(layout, members, names).find(select);
}

}  // namespace kinalign
