// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/trc.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/line_reader.h"
#include "kinalign/formats/point_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Times are in seconds, and their zero is that of the file.
constexpr TimeScale trc_seconds{1'000'000'000, 0};

/// Reads a TRC file: five lines of head, then rows. The head sets keys_ and names_, and its last
/// line sets header_.
class TrcReader final : public LineReader<PointReader> {
 public:
  TrcReader(const StreamOptions& options, std::string_view file)
      : LineReader(file, "the head of a TRC file",
                   RowStamps(true, options.rate_hz, options.start_ns)),
        options_(options) {}

 private:
  Result<void> read(std::string_view line, PointFrames& out) override {
    if (header_) return read_row(line, out);
    // The head has a fixed number of lines.
    switch (lines_.number()) {
      case 1:
        return expect(line.starts_with("PathFileType"), "PathFileType", line);
      case 2:
        // The keys are stored until line 3, which contains their values.
        keys_ = split_cells(line, '\t');
        return {};
      case 3:
        return read_facts(split_cells(line, '\t'));
      case 4:
        return read_names(split_cells(line, '\t'));
      default:
        return read_labels(split_cells(line, '\t'), line);
    }
  }

  static Result<void> expect(bool good, std::string expected, std::string_view found) {
    if (good) return {};
    return refuse(std::move(expected), shown(found));
  }

  /// Reads line 3, the values of the keys in line 2.
  Result<void> read_facts(const std::vector<std::string>& facts) {
    // Programs write different keys in different orders.
    for (std::size_t i = 0; i < std::min(keys_.size(), facts.size()); ++i) {
      if (keys_[i] == "NumFrames") {
        KA_TRY(expect(parse_number(facts[i], declared_), "a number of frames", facts[i]));
      }
      if (keys_[i] == "NumMarkers") markers_fact_ = facts[i];
      if (keys_[i] == "DataRate") parse_number(facts[i], data_rate_);
      if (keys_[i] == "Units") KA_TRY(read_unit(facts[i]));
    }
    // Without a unit, the positions can't be converted.
    return expect(units_.metres > 0.0, "Units among the keys of line 2", "none");
  }

  Result<void> read_unit(const std::string& unit) {
    const double metres = unit == "mm" ? 0.001 : unit == "cm" ? 0.01 : unit == "m" ? 1.0 : 0.0;
    KA_TRY(expect(metres > 0.0, "units mm, cm or m", unit));
    units_ = point_units({y_up, metres}, options_);
    return {};
  }

  /// Reads line 4, the names of the columns and markers.
  Result<void> read_names(std::vector<std::string> cells) {
    // Each name stands above the first of its three columns, so the other cells are empty.
    std::erase(cells, "");
    KA_TRY(expect(cells.size() > 2 && cells[0] == "Frame#" && cells[1] == "Time",
                  "Frame#, Time and names of markers", cells.empty() ? "" : cells[0]));
    names_.assign(cells.begin() + 2, cells.end());
    double declared = 0.0;
    // The number of markers follows from the names. A different stated number is only a finding.
    if (parse_number(markers_fact_, declared) && declared == static_cast<double>(names_.size())) {
      return {};
    }
    add_warning(
        findings,
        lines_.error(shown(markers_fact_) + " names of markers", std::to_string(names_.size())),
        "the named markers were read");
    return {};
  }

  /// Reads line 5, the labels X1 Y1 Z1 X2 and so on. Their number determines the width of a row.
  Result<void> read_labels(std::vector<std::string> cells, std::string_view line) {
    // The cells above Frame# and Time are empty.
    std::erase(cells, "");
    KA_TRY(expect(cells.size() == 3 * names_.size() && cells[0] == "X1",
                  std::to_string(3 * names_.size()) + " labels X1, Y1, Z1, ...", line));
    // Frame# is not read. Time is read as a text, so that it is exact to the nanosecond.
    std::vector<ColumnUse> uses(2 + cells.size());
    uses[1].text = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) uses[2 + i].slot = static_cast<int>(i);
    row_ = RowParser('\t', std::move(uses));
    states_.resize(names_.size());
    header_ = PointHeader{names_};
    return {};
  }

  /// Reads a row. A blank line ends the rows. Later lines are counted but not read.
  Result<void> read_row(std::string_view line, PointFrames& out) {
    if (trimmed(line).empty()) {
      // Some programs write an empty line between labels and rows.
      ended_ = stamps_.rows() > 0;  // a blank line before the rows is allowed
      return {};
    }
    if (ended_) {
      ++behind_the_end_;
      return {};
    }
    KA_TRY(row_.read(line));
    const auto ns = parse_stamp(row_.texts[0], trc_seconds);
    KA_TRY(expect(ns.has_value(), "a time in seconds", row_.texts[0]));
    // These times are compared with DataRate at the end.
    if (stamps_.rows() == 0) first_ns_ = *ns;
    last_ns_ = *ns;
    PointFrames& target = held_.target(stamps_, out);
    target.stamps.push_back(KA_TRY(stamps_.next(*ns)));
    for (std::size_t j = 0; j < states_.size(); ++j) {
      // A marker is missing if one of its coordinates is missing.
      const bool missing =
          (row_.missing[3 * j] | row_.missing[3 * j + 1] | row_.missing[3 * j + 2]) != 0;
      states_[j] = missing ? Tracking::missing : Tracking::tracked;
    }
    append_points(units_, row_.values.data(), states_, target);
    held_.release(stamps_, out);
    return {};
  }

  Result<void> report() override {
    const std::string& file = lines_.file();
    // NumFrames is not used for reading. It is only compared.
    if (static_cast<double>(stamps_.rows()) != declared_) {
      add_warning(findings,
                  {file, 3, number_text(declared_, 0) + " frames", std::to_string(stamps_.rows())},
                  "the existing frames were read", "correct NumFrames");
    }
    const double seconds = 1e-9 * (static_cast<double>(last_ns_) - static_cast<double>(first_ns_));
    const double rate = static_cast<double>(stamps_.rows() - 1) / seconds;
    // If the rates differ by more than 10 %, DataRate or the times are wrong.
    if (seconds > 0.0 && data_rate_ > 0.0 && std::abs(rate - data_rate_) > 0.1 * data_rate_) {
      add_warning(findings,
                  {file, 3, fmt::format("times of DataRate {:g}", data_rate_),
                   fmt::format("{:.4g} frames per second", rate)},
                  "the times are used", "find out which is correct: gaps and splines depend on it");
    }
    if (behind_the_end_ > 0) {
      add_warning(findings,
                  {file, 0, "no rows after a blank line, which ends the data",
                   std::to_string(behind_the_end_) + " lines"},
                  "these rows were not read", "remove the blank line");
    }
    return {};
  }

  StreamOptions options_;
  PointUnits units_{y_up, 0.0};
  std::vector<std::string> keys_, names_;
  std::string markers_fact_;
  double declared_ = 0.0, data_rate_ = 0.0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;  // times of the first and the last row, ns
  RowParser row_;
  std::vector<Tracking> states_;  // [J] of the current row
  bool ended_ = false;
  std::uint64_t behind_the_end_ = 0;
};

}  // namespace

std::unique_ptr<PointReader> make_trc_reader(const StreamOptions& options, std::string_view file) {
  return std::make_unique<TrcReader>(options, file);
}

bool looks_like_trc(std::string_view head) {
  return without_byte_order_mark(head).starts_with("PathFileType");
}

}  // namespace kinalign
