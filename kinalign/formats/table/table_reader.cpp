// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/table_reader.h"

#include "kinalign/core/files.h"
#include "kinalign/core/numbers.h"
#include "kinalign/formats/imu_converter.h"
#include "kinalign/formats/line_reader.h"
#include "kinalign/formats/point_rows.h"
#include "kinalign/formats/table/table_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace kinalign {

namespace {

/// Makes points from parsed rows. It is one of the two builders for TableReader. A builder only
/// knows the kind of the stream, and not how rows are read.
class PointBuilder {
 public:
  using ReaderType = PointReader;
  static constexpr const char* without = "every joint with a position counts as tracked";

  PointBuilder(const TableLayout& layout, const StreamOptions& options,
               const std::vector<std::string>& joints)
      : layout_(layout),
        units_(point_units({layout.axes, layout.metres_per_unit}, options)),
        states_(joints.size()),
        mirror_(joints) {}

  PointHeader header(const std::vector<std::string>& joints, const TableColumns&) const {
    return {joints};
  }

  Result<void> append(const RowParser& row, const TableColumns& columns, PointFrames& out) {
    for (std::size_t j = 0; j < states_.size(); ++j) {
      states_[j] = KA_TRY(state_of(row, columns, j));
    }
    append_points(units_, row.values.data(), states_, out);
    // The positions of the last row, in kinalign's axes.
    const std::size_t first = out.positions.size() - 3 * states_.size();
    mirror_.watch(&out.positions[first], states_.data());
    return {};
  }

  void report(const std::string& file, Findings& findings) const { mirror_.report(file, findings); }

 private:
  Result<Tracking> state_of(const RowParser& row, const TableColumns& columns,
                            std::size_t j) const {
    const double* p = &row.values[3 * j];
    // any_missing is almost always false. The test saves three look-ups per joint.
    if (row.any_missing && (row.missing[3 * j] | row.missing[3 * j + 1] | row.missing[3 * j + 2])) {
      return Tracking::missing;
    }
    // Some programs write a fixed position for a joint that was not seen.
    const std::vector<double>& unseen = layout_.missing_point;
    if (!unseen.empty() && std::equal(p, p + 3, unseen.begin())) return Tracking::missing;
    // Without a column of states, every joint with a position counts as tracked.
    if (columns.states < 0) return Tracking::tracked;
    const std::size_t slot = static_cast<std::size_t>(columns.states) + j;
    return row.missing[slot] != 0 ? Tracking::missing : named_state(row.values[slot]);
  }

  /// Searches the short lists of state numbers one after the other.
  Result<Tracking> named_state(double value) const {
    const auto among = [value](const std::vector<double>& values) {
      return std::find(values.begin(), values.end(), value) != values.end();
    };
    if (among(layout_.state.tracked)) return Tracking::tracked;
    if (among(layout_.state.inferred)) return Tracking::inferred;
    if (among(layout_.state.missing)) return Tracking::missing;
    return refuse("a tracking state that the layout names", number_text(value, 0));
  }

  const TableLayout& layout_;
  PointUnits units_;
  std::vector<Tracking> states_;
  MirrorWatch mirror_;
};

/// Makes inertial samples from parsed rows, one sample per node and row.
class ImuBuilder {
 public:
  using ReaderType = ImuReader;
  static constexpr const char* without = "this quantity is missing for all nodes";

  ImuBuilder(const TableLayout& layout, const StreamOptions& options,
             const std::vector<std::string>& nodes)
      : gravity_(layout.gravity),
        nodes_(nodes.size()),
        rows_({axes_of(layout.axes, options), layout.acceleration_unit,
               layout.angular_velocity_unit}) {}

  ImuHeader header(const std::vector<std::string>& nodes, const TableColumns& columns) const {
    return {nodes,
            {columns.orientation >= 0, columns.acceleration >= 0, columns.angular_velocity >= 0,
             gravity_}};
  }

  Result<void> append(const RowParser& row, const TableColumns& columns, ImuSamples& out) {
    // The pointer of a quantity stays nullptr if the file lacks the quantity.
    for (std::size_t s = 0; s < nodes_; ++s) {
      RawImuSample sample;
      sample.orientation = quantity(row, columns.orientation, 4, s, sample.valid);
      sample.acceleration = quantity(row, columns.acceleration, 3, s, sample.valid);
      sample.angular_velocity = quantity(row, columns.angular_velocity, 3, s, sample.valid);
      rows_.append(sample, out);
    }
    return {};
  }

  void report(const std::string& file, Findings& findings) const { rows_.report(file, findings); }

 private:
  /// A pointer to a node's numbers of one quantity. Sets `valid` to false if one of them is
  /// missing.
  static const double* quantity(const RowParser& row, int first, std::size_t parts,
                                std::size_t node, bool& valid) {
    if (first < 0) return nullptr;
    const std::size_t slot = static_cast<std::size_t>(first) + parts * node;
    for (std::size_t i = 0; i < parts; ++i) valid = valid && row.missing[slot + i] == 0;
    return &row.values[slot];
  }

  bool gravity_;
  std::size_t nodes_;
  ImuConverter rows_;
};

/// Reads both kinds of tables. Each line is skipped, or names the columns, or is a row. The layout
/// decides this before the first row. The builder converts rows to points or samples.
template <class Builder>
class TableReader final : public LineReader<typename Builder::ReaderType> {
 public:
  using Base = LineReader<typename Builder::ReaderType>;
  using typename Base::Frames;

  TableReader(const TableLayout& layout, const StreamOptions& options, std::string_view file,
              std::vector<std::string> members)
      : Base(file, "a table of layout " + layout.name,
             RowStamps(layout.time.has_value(),
                       options.rate_hz > 0.0 ? options.rate_hz : layout.rate_hz, options.start_ns)),
        layout_(layout),
        members_(std::move(members)),
        select_(options.select),
        own_layout_(options.own_layout()),
        builder_(layout_, options, members_) {
    // If both the user and the layout select by a column, insert() keeps the user's value.
    for (const auto& choice : layout.select) select_.insert(choice);
  }

 private:
  using Base::held_, Base::header_, Base::lines_, Base::stamps_;

  Result<void> report() override {
    report_absent();
    builder_.report(lines_.file(), this->findings);
    selection_.report(lines_.file(), this->findings);
    return {};
  }

  /// Adds a finding about quantities that the file lacks. A misspelt name in the layout or in the
  /// file can't be distinguished from a missing quantity.
  void report_absent() {
    // A built-in layout fits many files. Only if the file has unused columns may a name be
    // misspelt.
    if (!own_layout_ && columns_.unread == 0) return;
    for (const std::string& column : columns_.absent) {
      add_note(
          this->findings,
          {lines_.file(), 0, "a column " + shown(column) + ", as layout " + layout_.name + " says",
           "no such column"},
          Builder::without,
          own_layout_
              ? "if the file has no such column, remove it from the layout"
              : fmt::format("if it is one of the {} unread columns, use its name in the layout",
                            columns_.unread));
    }
  }

  Result<void> read(std::string_view line, Frames& out) override {
    // Lines of the file are counted, including comments.
    if (static_cast<std::size_t>(lines_.number()) <= layout_.skip_lines) return {};
    if (!layout_.comment.empty() && line.starts_with(layout_.comment)) return {};
    if (trimmed(line).empty()) return {};
    if (header_) return read_row(line, out);
    if (layout_.header) return read_head(split_cells(line, layout_.delimiter));
    // Without a line of names, the first line is a row.
    KA_TRY(read_head({}));
    return read_row(line, out);
  }

  /// Finds the columns, with or without a line of names.
  Result<void> read_head(const std::vector<std::string>& names) {
    if (!layout_.time && stamps_.rate_hz() <= 0.0) {
      return Failure(lines_.error("rate_hz for rows without stamps", "none"));
    }
    // The columns are found only once. Afterwards rows are read without comparing names.
    columns_ = KA_TRY(find_columns(layout_, members_, select_, names));
    selection_ = RowSelection(columns_.choices, columns_.body);
    row_ = RowParser(layout_.delimiter, columns_.uses);
    header_ = builder_.header(members_, columns_);
    return {};
  }

  Result<void> read_row(std::string_view line, Frames& out) {
    KA_TRY(row_.read(line));
    // Rows that are not selected get no stamp.
    if (!selection_.takes(row_.texts)) return {};
    const std::int64_t ns = KA_TRY(column_stamp());
    // The row is appended to `out`, or kept until the stamps are final.
    Frames& target = held_.target(stamps_, out);
    const Time stamp = KA_TRY(stamps_.next(ns));
    KA_TRY(builder_.append(row_, columns_, target));
    target.stamps.push_back(stamp);
    held_.release(stamps_, out);
    return {};
  }

  Result<std::int64_t> column_stamp() const {
    // Without a time column, RowStamps counts the rows.
    if (columns_.time_text < 0) return 0;
    const std::string_view cell = row_.texts[static_cast<std::size_t>(columns_.time_text)];
    if (const auto ns = parse_stamp(cell, layout_.time->scale)) return *ns;
    return refuse("a stamp inside +-4e18 ns", shown(cell));
  }

  TableLayout layout_;
  std::vector<std::string> members_;
  std::map<std::string, std::string> select_;
  bool own_layout_;
  Builder builder_;
  TableColumns columns_;
  RowSelection selection_;
  RowParser row_;
};

}  // namespace

std::unique_ptr<PointReader> make_point_table_reader(const TableLayout& layout,
                                                     const StreamOptions& options,
                                                     std::string_view file) {
  assert(layout.kind == TableKind::points);
  return std::make_unique<TableReader<PointBuilder>>(layout, options, file, layout.names);
}

std::unique_ptr<ImuReader> make_imu_table_reader(const TableLayout& layout,
                                                 const StreamOptions& options,
                                                 std::string_view file, std::string_view node) {
  assert(layout.kind == TableKind::imu);
  std::vector<std::string> nodes = layout.names;
  // The file contains a single node.
  if (nodes.empty()) {
    const std::string_view name = file_name(file);
    nodes.emplace_back(node.empty() ? name.substr(0, name.rfind('.')) : node);
  }
  return std::make_unique<TableReader<ImuBuilder>>(layout, options, file, std::move(nodes));
}

namespace {

/// Calls `use(reader, good)` with a reader that has read the beginning of a file. `good`: it could
/// be read.
template <class Use>
bool read_head_of_file(const TableLayout& layout, std::string_view head, Use&& use) {
  // The value of the rate does not matter, because only the form of the rows is tested.
  StreamOptions options;
  options.rate_hz = layout.rate_hz > 0.0 ? layout.rate_hz : 1.0;
  const std::size_t whole = head.rfind('\n');
  if (whole != std::string_view::npos) head = head.substr(0, whole + 1);  // without the cut line
  // The layout fits if the beginning of the file can be read with it.
  const auto reads = [&](auto reader) {
    typename std::decay_t<decltype(*reader)>::Frames frames;
    const bool good = reader->feed(head, frames) && reader->finish(frames);
    return use(*reader, good);
  };
  return layout.kind == TableKind::points
             ? reads(make_point_table_reader(layout, options, "head"))
             : reads(make_imu_table_reader(layout, options, "head", "node"));
}

}  // namespace

bool matches(const TableLayout& layout, std::string_view head) {
  return read_head_of_file(layout, head, [](const auto&, bool good) { return good; });
}

bool knows_columns(const TableLayout& layout, std::string_view head) {
  return layout.header && read_head_of_file(layout, head, [](const auto& reader, bool) {
           return reader.header() != nullptr;
         });
}

}  // namespace kinalign
