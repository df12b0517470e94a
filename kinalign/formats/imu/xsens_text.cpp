// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/imu/xsens_text.h"

#include "kinalign/core/files.h"
#include "kinalign/core/numbers.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/imu/packet_count.h"
#include "kinalign/formats/imu_converter.h"
#include "kinalign/formats/named_lines.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/motion/arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace kinalign {

namespace {

/// The slots of one quantity's columns in RowParser::values, in the order of the wanted names. The
/// list is empty if the file lacks one of the columns.
struct XsensGroup {
  std::vector<std::size_t> slots;

  bool there() const { return !slots.empty(); }
  bool whole(const RowParser& row) const {
    return there() && std::all_of(slots.begin(), slots.end(),
                                  [&](std::size_t i) { return row.missing[i] == 0; });
  }
};

struct XsensColumns {
  std::vector<ColumnUse> uses;
  XsensGroup counter, quaternion, matrix, euler, acceleration, free_acceleration, angular_velocity;
};

/// Finds groups of columns by name, and gives each column a slot in RowParser::values. A group is
/// found only if all its columns exist. A column may be in several groups.
class ColumnFinder {
 public:
  explicit ColumnFinder(const std::vector<std::string>& names)
      : names_(names), uses_(names.size()) {}

  XsensGroup find(const std::vector<std::string_view>& wanted) {
    std::vector<std::size_t> columns;
    for (const std::string_view name : wanted) {
      const auto at = std::find(names_.begin(), names_.end(), name);
      if (at == names_.end()) return {};
      columns.push_back(static_cast<std::size_t>(at - names_.begin()));
    }
    XsensGroup group;
    for (const std::size_t column : columns) {
      // A column gets one slot, even if it is in two groups.
      if (uses_[column].slot < 0) uses_[column].slot = slots_++;
      group.slots.push_back(static_cast<std::size_t>(uses_[column].slot));
    }
    return group;
  }

  std::vector<ColumnUse> uses() const { return uses_; }

 private:
  const std::vector<std::string>& names_;
  std::vector<ColumnUse> uses_;
  int slots_ = 0;
};

double value(const XsensGroup& group, const RowParser& row, std::size_t i) {
  return row.values[group.slots[i]];
}

/// The delimiter in the line of column names: tab, comma, semicolon, bar, colon or blank.
std::optional<char> xsens_delimiter(std::string_view names) {
  for (const char delimiter : {'\t', ',', ';', '|', ':', ' '}) {
    if (names.find(delimiter) != std::string_view::npos) return delimiter;
  }
  return std::nullopt;
}

/// Finds the columns of each quantity by the names that MT Manager writes.
XsensColumns find_xsens_columns(const std::vector<std::string>& names) {
  ColumnFinder finder(names);
  XsensColumns columns;
  columns.counter = finder.find({"PacketCounter"});
  columns.quaternion = finder.find({"Quat_q0", "Quat_q1", "Quat_q2", "Quat_q3"});
  columns.matrix = finder.find({"Mat[1][1]", "Mat[1][2]", "Mat[1][3]", "Mat[2][1]", "Mat[2][2]",
                                "Mat[2][3]", "Mat[3][1]", "Mat[3][2]", "Mat[3][3]"});
  columns.euler = finder.find({"Roll", "Pitch", "Yaw"});
  columns.acceleration = finder.find({"Acc_X", "Acc_Y", "Acc_Z"});
  columns.free_acceleration = finder.find({"FreeAcc_X", "FreeAcc_Y", "FreeAcc_Z"});
  // Some exports name the axes of the world: east, north and up.
  if (!columns.free_acceleration.there()) {
    columns.free_acceleration = finder.find({"FreeAcc_E", "FreeAcc_N", "FreeAcc_U"});
  }
  columns.angular_velocity = finder.find({"Gyr_X", "Gyr_Y", "Gyr_Z"});
  columns.uses = finder.uses();
  return columns;
}

// Each of the following functions returns world_from_sensor for a row, world z up, not normalised.
// All columns of the group must have values in the row.
Quat xsens_quaternion(const XsensGroup& group, const RowParser& row) {
  return {value(group, row, 0), value(group, row, 1), value(group, row, 2), value(group, row, 3)};
}

/// Reads the rotation matrix in the columns Mat[row][column].
Quat xsens_from_matrix(const XsensGroup& group, const RowParser& row) {
  Eigen::Matrix3d matrix;
  for (Eigen::Index i = 0; i < 9; ++i) {
    matrix(i / 3, i % 3) = value(group, row, static_cast<std::size_t>(i));
  }
  // The numbers are rounded, so the matrix is nearly a rotation. The result is normalised later.
  return Quat(matrix);
}

/// Reads roll, pitch and yaw in degrees: R = Rz Ry Rx.
Quat xsens_from_euler(const XsensGroup& group, const RowParser& row) {
  constexpr double degree = std::numbers::pi / 180.0;
  const Eigen::AngleAxisd roll(value(group, row, 0) * degree, Vec3::UnitX());
  const Eigen::AngleAxisd pitch(value(group, row, 1) * degree, Vec3::UnitY());
  const Eigen::AngleAxisd yaw(value(group, row, 2) * degree, Vec3::UnitZ());
  return yaw * pitch * roll;
}

/// The id of the device in a file name: "MT_012005D6_009-001_00B421E6.txt" gives "00B421E6". A name
/// without an id is returned without its extension.
std::string device_of(std::string_view file) {
  std::string_view name = file_name(file);
  name = name.substr(0, name.rfind('.'));
  // The id of a device has eight digits.
  const std::string_view id = name.size() > 8 ? name.substr(name.size() - 8) : name;
  const bool hexadecimal = id.find_first_not_of("0123456789ABCDEFabcdef") == std::string_view::npos;
  return std::string(hexadecimal ? id : name);
}

/// Counts rows with quantities that the first rows did not have. The header must be known before
/// the first row is passed on, so such a quantity is left out.
class LateQuantities {
 public:
  /// Call this for each row. `here`: the quantities with values in this row. `read`: the quantities
  /// in the header.
  void add(const ImuContent& here, const ImuContent& read) {
    const std::array late{here.orientation && !read.orientation,
                          here.acceleration && !read.acceleration,
                          here.angular_velocity && !read.angular_velocity};
    for (std::size_t i = 0; i < late.size(); ++i) is_late_[i] |= late[i];
    rows_ += late[0] || late[1] || late[2] ? 1 : 0;
  }

  /// The number of rows with at least one such quantity.
  std::uint64_t rows() const { return rows_; }

  /// The names of these quantities, for example "orientation, angular velocity".
  std::string names() const {
    constexpr std::array names{"orientation", "acceleration", "angular velocity"};
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (is_late_[i]) out += (out.empty() ? "" : ", ") + std::string(names[i]);
    }
    return out;
  }

 private:
  std::uint64_t rows_ = 0;
  std::array<bool, 3> is_late_{};
};

/// Reads an export. The first `patience` rows wait, because they show which quantities the file
/// contains. They are then passed on in their order.
class XsensReader final : public ImuReader {
 public:
  XsensReader(const StreamOptions& options, std::string_view file, std::string_view node)
      : lines_(file),
        options_(options),
        node_(node.empty() ? device_of(file) : std::string(node)),
        rate_hz_(options.rate_hz),
        samples_(ImuUnits{axes_of(z_up, options), 1.0, 1.0}) {}

  Result<void> feed(std::string_view piece, ImuSamples& out) override {
    return lines_.feed(piece, [&](std::string_view line) { return read(line, out); });
  }

  Result<void> finish(ImuSamples& out) override {
    const auto use = [&](std::string_view line) { return read(line, out); };
    const bool rows = header_ || !waiting_.empty();
    // If the file has no row, it ends within its head.
    KA_TRY(rows ? lines_.finish(use, findings) : lines_.finish_head(use, findings));
    // In a file with few rows, the quantities are decided at its end.
    if (!header_) settle(out);
    if (!header_) return Failure(lines_.error("rows of an Xsens export", "the end of the file"));
    if (packets_.lost() > 0) {
      findings.push_back(
          {Severity::note,
           Error{lines_.file(), 0, "every packet", std::to_string(packets_.lost()) + " lost"},
           "the missing packets are gaps", ""});
    }
    if (packets_.guessed() > 0) {
      findings.push_back(
          {Severity::warning,
           Error{lines_.file(), 0, "a rising PacketCounter",
                 "a lower one, as if " + std::to_string(packets_.guessed()) + " packets were lost"},
           "the later stamps are correct only if these packets were lost",
           "if the device restarted, cut the file there"});
    }
    if (late_.rows() > 0) {
      findings.push_back(
          {Severity::warning,
           Error{lines_.file(), 0,
                 "every quantity within the first " + std::to_string(patience) + " rows",
                 std::to_string(late_.rows()) +
                     " rows with values that begin later: " + late_.names()},
           "quantities that begin later were left out", "remove the earlier rows from the file"});
    }
    samples_.report(lines_.file(), findings);
    return {};
  }

  const ImuHeader* header() const override { return header_ ? &*header_ : nullptr; }

 private:
  Result<void> read(std::string_view line, ImuSamples& out) {
    // Comments usually stand above the names, but are accepted everywhere.
    if (line.starts_with("//")) return read_comment(line);
    if (trimmed(line).empty()) return {};
    return named_ ? read_row(line, out) : read_names(line);
  }

  /// Reads the rate from the comment "Update Rate: ...", unless the user gave a rate.
  Result<void> read_comment(std::string_view line) {
    constexpr std::string_view key = "Update Rate:";
    const auto at = line.find(key);
    // The user's rate has priority over the rate in the file.
    if (at == std::string_view::npos || options_.rate_hz > 0.0) return {};
    std::string_view text = trimmed(line.substr(at + key.size()));
    if (text.ends_with("Hz")) text.remove_suffix(2);
    if (parse_number(trimmed(text), rate_hz_) && rate_hz_ >= 1e-3 && rate_hz_ <= 1e6) return {};
    return Failure(Error{"", 0, "Update Rate: 100.0Hz", shown(trimmed(line))});
  }

  /// Reads the line of column names.
  Result<void> read_names(std::string_view line) {
    const auto delimiter = xsens_delimiter(trimmed(line));
    if (!delimiter) return Failure(Error{"", 0, "names of columns", shown(line)});
    // The names determine the meaning of all columns, whose order is free.
    columns_ = find_xsens_columns(split_cells(line, *delimiter));
    if (!columns_.counter.there()) {
      return Failure(Error{"", 0, "a column PacketCounter", "no such column"});
    }
    // A rate is needed, because a stamp is the packet counter divided by the rate.
    if (rate_hz_ <= 0.0) {
      return Failure(Error{"", 0, "a line // Update Rate: ... above, or rate_hz", "none"});
    }
    row_ = RowParser(*delimiter, columns_.uses);
    named_ = true;
    return {};
  }

  /// Reads a row. The first rows are kept until the quantities are decided.
  Result<void> read_row(std::string_view line, ImuSamples& out) {
    KA_TRY(row_.read(line));
    // Without a packet counter, a row has no stamp.
    const bool packet = columns_.counter.whole(row_);
    if (!packet) return Failure(Error{"", 0, "a whole number as PacketCounter", "an empty cell"});
    const ImuContent here = content_of_row();
    // Rows before the first measurement are ignored.
    const bool is_any = here.orientation || here.acceleration || here.angular_velocity;
    if (!header_ && waiting_.empty() && !is_any) return {};
    const auto count = KA_TRY(packets_.next(row_.values[columns_.counter.slots[0]]));
    const Time stamp = KA_TRY(stamp_of(count));
    if (!header_) {
      waiting_.push_back({stamp, row_.values, row_.missing});
      see(here);
      if (waiting_.size() == patience) settle(out);
      return {};
    }
    // Quantities that the header does not contain are counted for a finding.
    late_.add(here, header_->content);
    append_sample(stamp, out);
    return {};
  }

  /// The quantities with complete values in this row. A column may be empty in some rows.
  ImuContent content_of_row() const {
    ImuContent here;
    // One of the three forms of orientation is enough.
    here.orientation = columns_.quaternion.whole(row_) || columns_.matrix.whole(row_) ||
                       columns_.euler.whole(row_);
    here.gravity = columns_.acceleration.whole(row_);
    // An acceleration without gravity is in world space, so the orientation is needed to convert
    // it.
    here.acceleration =
        here.gravity || (here.orientation && columns_.free_acceleration.whole(row_));
    here.angular_velocity = columns_.angular_velocity.whole(row_);
    return here;
  }

  /// Counts how many of the kept rows have each quantity.
  void see(const ImuContent& here) {
    // The three forms of orientation are counted separately, because some of their columns may be
    // empty.
    for (std::size_t k = 0; k < turns_.size(); ++k) {
      turns_[k].rows += turns_[k].group->whole(row_) ? 1 : 0;
    }
    with_gravity_ += here.gravity ? 1 : 0;
    free_ += here.orientation && columns_.free_acceleration.whole(row_) ? 1 : 0;
    seen_.angular_velocity |= here.angular_velocity;
  }

  /// Decides which quantities the file has, and appends the kept rows. If the file has several
  /// forms of orientation or acceleration, the form that most rows have is read.
  void settle(ImuSamples& out) {
    if (waiting_.empty()) return;
    // If the counts are equal, the first form is used, which is the quaternion.
    const auto best = std::max_element(
        turns_.begin(), turns_.end(),
        [](const Orientation& a, const Orientation& b) { return a.rows < b.rows; });
    orientation_ = best->group;
    seen_.orientation = best->rows > 0;
    seen_.acceleration = with_gravity_ + free_ > 0;
    // If both accelerations have equally many rows, the one with gravity is read, because it is a
    // direct measurement.
    seen_.gravity = with_gravity_ >= free_;
    header_ = ImuHeader{{node_}, seen_};
    // The kept rows contain parsed numbers. Each row becomes the current row again.
    for (Waiting& row : waiting_) {
      row_.values = std::move(row.values);
      row_.missing = std::move(row.missing);
      append_sample(row.stamp, out);
    }
    waiting_.clear();
  }

  /// The stamp of packet `count`. The rate gives the time from packet 0 or, with start_ns, from the
  /// first row.
  Result<Time> stamp_of(std::int64_t count) {
    // Without start_ns, time 0 is counter 0, which is the same for all sensors of a recording.
    if (!first_count_) first_count_ = count;
    // A packet before the first one has a negative number.
    const std::int64_t packets = options_.start_ns ? count - *first_count_ : count;
    const std::int64_t since =
        stamp_at_rate(static_cast<std::uint64_t>(std::abs(packets)), rate_hz_);
    const std::int64_t ns = options_.start_ns.value_or(0) + (packets < 0 ? -since : since);
    if (std::abs(ns) <= largest_stamp_ns) return utc_time(ns);
    return Failure(Error{"", 0, "a stamp inside +-4e18 ns", std::to_string(count) + " packets"});
  }

  /// Converts the current row to a sample. The sample is invalid if a quantity of the header is
  /// absent.
  void append_sample(Time stamp, ImuSamples& out) {
    const ImuContent& content = header_->content;
    const XsensGroup& force = content.gravity ? columns_.acceleration : columns_.free_acceleration;
    RawImuSample sample;
    std::array<double, 4> orientation{1, 0, 0, 0};
    std::array<double, 3> acceleration{}, angular_velocity{};
    if (content.orientation) {
      sample.orientation = orientation.data();
      sample.valid = orientation_->whole(row_);
      // If the orientation is absent, it stays the identity, which into_sensor() can use.
      if (sample.valid) put_quat(orientation, 0, quaternion());
    }
    if (content.acceleration) {
      sample.acceleration = acceleration.data();
      sample.valid = sample.valid && force.whole(row_);
      copy(force, acceleration);
      // The converter expects every vector in sensor space.
      if (!content.gravity) into_sensor(orientation, acceleration);
    }
    if (content.angular_velocity) {
      sample.angular_velocity = angular_velocity.data();
      sample.valid = sample.valid && columns_.angular_velocity.whole(row_);
      copy(columns_.angular_velocity, angular_velocity);
    }
    samples_.append(sample, out);
    out.stamps.push_back(stamp);
  }

  Quat quaternion() const {
    if (orientation_ == &columns_.quaternion) return xsens_quaternion(*orientation_, row_);
    if (orientation_ == &columns_.matrix) return xsens_from_matrix(*orientation_, row_);
    return xsens_from_euler(*orientation_, row_);
  }

  void copy(const XsensGroup& group, std::array<double, 3>& to) const {
    for (std::size_t i = 0; i < 3; ++i) to[i] = row_.values[group.slots[i]];
  }

  /// Rotates a vector of FreeAcc from world space to sensor space.
  static void into_sensor(const std::array<double, 4>& orientation, std::array<double, 3>& vector) {
    const Quat q = quat(orientation, 0);
    if (q.norm() < 1e-6) return;  // the converter makes such a sample invalid
    const Vec3 world(vector[0], vector[1], vector[2]);
    const Vec3 sensor = q.normalized().conjugate() * world;
    std::copy_n(sensor.data(), 3, vector.begin());
  }

  NamedLines lines_;
  StreamOptions options_;
  std::string node_;
  double rate_hz_;
  ImuConverter samples_;
  bool named_ = false;
  XsensColumns columns_;
  const XsensGroup* orientation_ = nullptr;  // the chosen group in columns_
  RowParser row_;
  PacketCount packets_;
  std::optional<std::int64_t> first_count_;
  std::optional<ImuHeader> header_;

  /// A row that was read before the quantities were decided. Its stamp is kept, too, because the
  /// counter has advanced since.
  struct Waiting {
    Time stamp;
    std::vector<double> values;
    std::vector<std::uint8_t> missing;
  };
  static constexpr std::size_t patience = 32;  // number of rows until the quantities are decided
  std::vector<Waiting> waiting_;
  /// One form of the orientation.
  struct Orientation {
    const XsensGroup* group;
    std::size_t rows = 0;  // number of kept rows with this form
  };
  std::array<Orientation, 3> turns_{
      {{&columns_.quaternion}, {&columns_.matrix}, {&columns_.euler}}};
  std::size_t with_gravity_ = 0, free_ = 0;
  ImuContent seen_;
  LateQuantities late_;  // quantities that none of the kept rows had
};

}  // namespace

std::unique_ptr<ImuReader> make_xsens_text_reader(const StreamOptions& options,
                                                  std::string_view file, std::string_view node) {
  return std::make_unique<XsensReader>(options, file, node);
}

bool looks_like_xsens_text(std::string_view head) {
  // An export has fewer than 40 lines of comments.
  for (std::size_t line = 0; line < 40 && !head.empty(); ++line) {
    const auto end = head.find('\n');
    const std::string_view text = head.substr(0, end);
    head.remove_prefix(end == std::string_view::npos ? head.size() : end + 1);
    if (!text.starts_with("//") && !trimmed(text).empty()) return text.starts_with("PacketCounter");
  }
  return false;
}

}  // namespace kinalign
