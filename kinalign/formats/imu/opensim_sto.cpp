// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/imu/opensim_sto.h"

#include "kinalign/formats/cells.h"
#include "kinalign/formats/held_rows.h"
#include "kinalign/formats/imu_converter.h"
#include "kinalign/formats/named_lines.h"

#include <algorithm>

namespace kinalign {

namespace {

// Times are in seconds, and their zero is that of the file.
constexpr TimeScale sto_seconds{1'000'000'000, 0};

/// Reads a .sto file line by line: the head up to endheader, a line of names, then rows. in_head_
/// is true up to endheader. The line of names sets header_.
class StoReader final : public ImuReader {
 public:
  StoReader(const StreamOptions& options, std::string_view file)
      : lines_(file),
        stamps_(true, options.rate_hz, options.start_ns),
        samples_(ImuUnits{axes_of(z_up, options), 1.0, 1.0}),
        // Four numbers with commas between them form one cell. parts_ splits them.
        parts_(',', {{0, -1}, {1, -1}, {2, -1}, {3, -1}}) {}

  Result<void> feed(std::string_view piece, ImuSamples& out) override {
    return lines_.feed(piece, [&](std::string_view line) { return read(line, out); });
  }

  Result<void> finish(ImuSamples& out) override {
    const auto use = [&](std::string_view line) { return read(line, out); };
    // A file that ends within its head is incomplete.
    KA_TRY(header_ ? lines_.finish(use, findings) : lines_.finish_head(use, findings));
    if (!header_) return Failure(lines_.error("the head of a .sto file", "the end of the file"));
    stamps_.settle();
    counted = stamps_.counted();
    held_.release(stamps_, out);
    if (stamps_.stuck()) findings.push_back(stuck_finding(lines_.file(), stamps_));
    samples_.report(lines_.file(), findings);
    return {};
  }

  const ImuHeader* header() const override { return header_ ? &*header_ : nullptr; }

 private:
  Result<void> read(std::string_view line, ImuSamples& out) {
    // Blank lines are ignored everywhere.
    if (trimmed(line).empty()) return {};
    if (header_) return read_row(line, out);
    return in_head_ ? read_head(trimmed(line)) : read_names(split_cells(line, '\t'));
  }

  /// Reads a line of the head. Only DataType and endheader matter.
  Result<void> read_head(std::string_view line) {
    if (line.starts_with("DataType=")) {
      const std::string_view type = trimmed(line.substr(line.find('=') + 1));
      quaternions_ = type == "Quaternion";
      if (!quaternions_) return Failure(Error{"", 0, "DataType=Quaternion", shown(type)});
    }
    if (line != "endheader") return {};
    // Without this key, the type of the values is unknown.
    if (!quaternions_) return Failure(Error{"", 0, "DataType=Quaternion in the head", "none"});
    in_head_ = false;
    return {};
  }

  /// Reads the line of column names, which completes the header.
  Result<void> read_names(const std::vector<std::string>& names) {
    // The first column is the time. Every further column is a node.
    if (names.size() < 2 || names[0] != "time") {
      return Failure(
          Error{"", 0, "time and names of nodes", names.empty() ? "none" : shown(names[0])});
    }
    std::vector<ColumnUse> uses(names.size());
    // Every cell is read as a text, because RowParser can't read a cell of four numbers.
    for (std::size_t i = 0; i < uses.size(); ++i) uses[i].text = static_cast<int>(i);
    row_ = RowParser('\t', std::move(uses));
    raw_.resize(4 * (names.size() - 1));
    valid_.resize(names.size() - 1);
    header_ = ImuHeader{{names.begin() + 1, names.end()}, {true, false, false, true}};
    return {};
  }

  /// Reads a row: the time and the quaternion of each node.
  Result<void> read_row(std::string_view line, ImuSamples& out) {
    KA_TRY(row_.read(line));
    const auto ns = parse_stamp(row_.texts[0], sto_seconds);
    if (!ns) return Failure(Error{"", 0, "a time in seconds", shown(row_.texts[0])});
    // All cells are read before anything is appended, so that a fault leaves no incomplete row.
    for (std::size_t s = 0; s < valid_.size(); ++s) KA_TRY(read_quaternion(row_.texts[s + 1], s));
    // Rows are kept until their stamps are final.
    ImuSamples& target = held_.target(stamps_, out);
    target.stamps.push_back(KA_TRY(stamps_.next(*ns)));
    for (std::size_t s = 0; s < valid_.size(); ++s) {
      samples_.append({&raw_[4 * s], nullptr, nullptr, valid_[s] != 0}, target);
    }
    held_.release(stamps_, out);
    return {};
  }

  /// Reads one cell "w,x,y,z". If the cell or a number is missing, the node's sample is invalid.
  Result<void> read_quaternion(std::string_view cell, std::size_t node) {
    // The cell of a lost sample is empty or "nan".
    valid_[node] = says_missing(cell) ? 0 : 1;
    if (valid_[node] == 0) return {};
    if (auto read = parts_.read(cell); !read) {
      return Failure(Error{"", 0, "w,x,y,z for " + shown(header_->node_names[node]), shown(cell)});
    }
    valid_[node] = parts_.any_missing ? 0 : 1;
    std::copy_n(parts_.values.begin(), 4, &raw_[4 * node]);
    return {};
  }

  NamedLines lines_;
  RowStamps stamps_;
  HeldRows<ImuSamples> held_;
  ImuConverter samples_;
  RowParser row_, parts_;
  bool in_head_ = true, quaternions_ = false;
  std::vector<double> raw_;          // [S,4] of the current row, w,x,y,z
  std::vector<std::uint8_t> valid_;  // [S] of the current row
  std::optional<ImuHeader> header_;
};

}  // namespace

std::unique_ptr<ImuReader> make_opensim_sto_reader(const StreamOptions& options,
                                                   std::string_view file) {
  return std::make_unique<StoReader>(options, file);
}

bool looks_like_opensim_sto(std::string_view head) {
  // The head of another type of .sto file does not contain the first text.
  return head.find("DataType=Quaternion") != std::string_view::npos &&
         head.find("endheader") != std::string_view::npos;
}

}  // namespace kinalign
