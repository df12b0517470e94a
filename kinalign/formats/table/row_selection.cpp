// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/row_selection.h"

#include "kinalign/core/numbers.h"

#include <algorithm>

namespace kinalign {

namespace {

// True if the cell has the chosen value. "0" and "0.0" are the same number.
bool holds(const RowChoice& choice, std::string_view cell) {
  if (cell == choice.value) return true;
  double one = 0.0;
  double other = 0.0;
  return parse_number(cell, one) && parse_number(choice.value, other) && one == other;
}

}  // namespace

void SeenValues::see(std::string_view value) {
  // The last value is compared first, because rows of one body usually follow each other.
  if (!values_.empty() && values_.back() == value) return;
  if (std::find(values_.begin(), values_.end(), value) != values_.end()) return;
  more_ = values_.size() == most;
  if (!more_) values_.emplace_back(value);
}

std::string SeenValues::list() const {
  std::string out;
  for (const std::string& value : values_) {
    out += (out.empty() ? "" : ", ") + (value.empty() ? "nothing" : shown(value));
  }
  return more_ ? out + ", ..." : out;
}

RowSelection::RowSelection(std::vector<RowChoice> choices, RowChoice body)
    : choices_(std::move(choices)), body_(std::move(body)), seen_(choices_.size()) {}

bool RowSelection::takes(const std::vector<std::string_view>& texts) {
  ++rows_;
  const bool taken = std::all_of(choices_.begin(), choices_.end(), [&](const RowChoice& choice) {
    return holds(choice, texts[choice.text]);
  });
  if (!taken) {
    // The values are kept until a row was selected. They are shown if no row fits.
    for (std::size_t i = 0; i < choices_.size() && taken_ == 0; ++i) {
      seen_[i].see(texts[choices_[i].text]);
    }
    return false;
  }
  ++taken_;
  if (!body_.column.empty()) bodies_.see(texts[body_.text]);
  return true;
}

void RowSelection::report(const std::string& file, Findings& findings) const {
  // Without this finding, an empty stream would be noticed much later.
  if (rows_ > 0 && taken_ == 0) {
    std::string wanted;
    std::string there;
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      const std::string column = (i > 0 ? ", " : "") + shown(choices_[i].column) + " ";
      wanted += column + shown(choices_[i].value);
      there += column + seen_[i].list();
    }
    findings.push_back({Severity::error,
                        Error{file, 0, "rows of " + wanted,
                              "no such row; " + std::to_string(rows_) + " rows of " + there},
                        "the stream is empty", "select existing values"});
  }
  // If no body is selected, the rows of all bodies are read as one body.
  if (bodies_.count() > 1) {
    add_warning(
        findings, {file, 0, "one body in the selected rows", body_.column + " " + bodies_.list()},
        "rows of several bodies are mixed in one stream",
        "select one body: select = { \"" + body_.column + "\" = " + shown(bodies_.first()) +
            " } in the manifest, --select \"" + body_.column + "=" + shown(bodies_.first()) + "\"");
  }
}

}  // namespace kinalign
