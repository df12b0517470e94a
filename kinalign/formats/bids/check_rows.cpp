// SPDX-License-Identifier: Apache-2.0
// Checks every cell of a motion.tsv. A repeated fault is one finding with the line of its first
// occurrence.
#include "kinalign/core/lines.h"
#include "kinalign/core/numbers.h"
#include "kinalign/formats/bids/channels.h"
#include "kinalign/formats/bids/check_context.h"
#include "kinalign/formats/cells.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

namespace kinalign {

namespace {

/// The count of a fault, with line and text of its first occurrence. A fault may occur in each of a
/// million rows.
struct Repeated {
  std::uint64_t times = 0;
  std::int64_t line = 0;
  std::string first;

  void add(std::int64_t at, std::string_view what) {
    if (times++ > 0) return;
    line = at;
    first = shown(what);
  }
  std::string found() const {
    return times == 1 ? first : fmt::format("{}, and {} more", first, times - 1);
  }
};

class RowsCheck {
 public:
  // Finds the columns of each quaternion. If a point does not have exactly four parts, its length
  // is not checked.
  explicit RowsCheck(const std::vector<BidsChannel>& channels) : channels_(channels) {
    std::map<std::string, std::array<std::size_t, 4>> quaternions;
    std::map<std::string, std::size_t> parts;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (channels[c].type == "LATENCY" && !latency_) latency_ = c;
      if (channels[c].type != "ORNT" || !channels[c].component.starts_with("quat_")) continue;
      // The count may exceed four, so that a repeated part is noticed.
      const std::size_t part = parts[channels[c].tracked_point]++;
      if (part < 4) quaternions[channels[c].tracked_point][part] = c;
    }
    for (const auto& [point, columns] : quaternions) {
      if (parts[point] == 4) quaternions_.push_back(columns);
    }
  }

  /// Checks one row. If the first line is mostly text, it is reported as a line of names and not
  /// checked further. values_ contains the numbers of the row, with NaN for missing values.
  Result<void> use(std::string_view line, std::int64_t number) {
    if (line.empty()) {
      blank_.add(number, "an empty line");
      return {};
    }
    values_.clear();
    // Only the first line may be a line of names.
    const bool first = summary.rows == 0 && names_.times == 0;
    std::size_t texts = 0;
    // The cells are read from the line directly, without a list of texts.
    for (std::string_view rest = line;;) {
      const auto tab = rest.find('\t');
      texts += read_cell(rest.substr(0, tab), number) ? 0 : 1;
      if (tab == std::string_view::npos) break;
      rest.remove_prefix(tab + 1);
    }
    if (first && 2 * texts > values_.size()) {  // a line of names
      names_.add(number, line.substr(0, line.find('\t')));
      // The cells of this line were counted as faults. These counts are removed.
      no_number_ = {};
      return {};
    }
    ++summary.rows;
    check_length(number);
    // In a row with a wrong number of cells, the channel of a cell is not known.
    if (values_.size() == channels_.size()) check_values(number);
    return {};
  }

  /// Converts the counted faults to findings, one for each kind of fault.
  void report(const std::string& path, BidsCheck& check) const {
    const auto report_rows = [&](const Repeated& fault, const std::string& expected) {
      if (fault.times > 0) check.error(path, expected, fault.found(), fault.line);
    };
    report_rows(names_, "only rows of numbers, without a line of column names");
    report_rows(blank_, "no empty lines");
    report_rows(lengths_, fmt::format("rows of {} cells, like the first row", width_));
    // All rows have the same number of cells, but channels.tsv has another number of rows.
    if (!channels_.empty() && width_ > 0 && width_ != channels_.size()) {
      check.error(path, fmt::format("{} columns, one per row of channels.tsv", channels_.size()),
                  std::to_string(width_));
    }
    report_rows(nan_, "n/a for what is missing");
    report_rows(no_number_, "a number or n/a");
    report_rows(latencies_, "rising latencies");
    if (quaternion_.times > 0) {
      check.warning(path, "quaternions of length 1", quaternion_.found(), quaternion_.line);
    }
    if (summary.rows == 0) check.error(path, "rows of samples", "none");
  }

  BidsRowsSummary summary;

 private:
  /// Appends the cell to the row. Returns false if the cell is neither a number nor a mark for a
  /// missing value.
  bool read_cell(std::string_view cell, std::int64_t line) {
    // NaN stands for a missing value. Comparisons with NaN are false.
    double value = NAN;
    bool good = true;
    if (cell != "n/a") {
      // Many programs accept "nan" and empty cells, but BIDS requires n/a.
      if (says_missing(cell)) {
        nan_.add(line, cell.empty() ? "an empty cell" : cell);
      } else if (!parse_number(cell, value) || !std::isfinite(value)) {
        no_number_.add(line, cell);
        value = NAN;
        good = false;
      }
    }
    values_.push_back(value);
    return good;
  }

  void check_length(std::int64_t line) {
    // Rows are compared with the first row, because channels.tsv itself may be wrong.
    if (width_ == 0) width_ = values_.size();
    if (values_.size() != width_) lengths_.add(line, std::to_string(values_.size()));
  }

  /// Checks a row with the right number of cells: latencies must rise, and quaternions must have
  /// length 1.
  void check_values(std::int64_t line) {
    if (latency_) {
      const double latency = values_[*latency_];
      // A missing latency is a fault, because each sample needs a time.
      if (!std::isfinite(latency) ||
          (summary.last_latency_s && latency <= *summary.last_latency_s)) {
        latencies_.add(line, fmt::format("{}", latency));
      }
      if (std::isfinite(latency)) {
        if (!summary.first_latency_s) summary.first_latency_s = latency;
        summary.last_latency_s = latency;
        ++summary.latencies;
      }
    }
    for (const auto& columns : quaternions_) {
      // If a part is NaN, the sum is NaN, so an incomplete quaternion is not checked.
      double square = 0.0;
      for (const std::size_t c : columns) square += values_[c] * values_[c];
      if (std::isfinite(square) && std::abs(std::sqrt(square) - 1.0) > 0.02) {
        quaternion_.add(line, fmt::format("{:.4g}", std::sqrt(square)));
      }
    }
  }

  const std::vector<BidsChannel>& channels_;
  std::optional<std::size_t> latency_;
  std::vector<std::array<std::size_t, 4>> quaternions_;
  std::vector<double> values_;  // the current row; NaN: missing
  std::size_t width_ = 0;
  Repeated names_, blank_, lengths_, nan_, no_number_, latencies_, quaternion_;
};

}  // namespace

BidsRowsSummary check_bids_rows(const std::string& path, const std::vector<BidsChannel>& channels,
                                BidsCheck& check) {
  RowsCheck rows(channels);
  LineSplitter lines;
  // `lines` knows the number of the current line.
  const auto use = [&](std::string_view line) { return rows.use(line, lines.number()); };
  auto read =
      check.listing.read(path, [&](std::string_view piece) { return lines.feed(piece, use); });
  if (read) read = lines.finish(use);
  // If the file can't be read to its end, only this error is reported.
  if (!read) {
    check.unreadable(path, read.error());
    return rows.summary;
  }
  rows.report(path, check);
  return rows.summary;
}

}  // namespace kinalign
