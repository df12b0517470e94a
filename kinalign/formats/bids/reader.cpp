// SPDX-License-Identifier: Apache-2.0
// Reads the rows of a motion.tsv as points or as inertial nodes.
#include "kinalign/core/numbers.h"
#include "kinalign/formats/bids/system.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/imu_converter.h"
#include "kinalign/formats/line_reader.h"
#include "kinalign/formats/point_rows.h"
#include "kinalign/formats/row_stamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace kinalign {

namespace {

// Latencies are seconds from the onset, so the scale has no offset.
constexpr TimeScale latency_seconds{1'000'000'000, 0};

/// The n columns of one quantity of a tracked point, in the order of kinalign's arrays, with the
/// factors of their units.
template <std::size_t n>
struct Quantity {
  std::array<std::size_t, n> columns{};
  std::array<double, n> scales{};
  std::string frame;
};

/// The columns of a quantity in channels.tsv. The result is empty if a component is missing. The
/// caller decides whether the quantity is needed.
template <std::size_t n>
std::optional<Quantity<n>> find_quantity(const BidsSystem& system, std::string_view point,
                                         std::string_view type,
                                         const std::array<const char*, n>& components) {
  Quantity<n> out;
  for (std::size_t k = 0; k < n; ++k) {
    const auto found =
        std::find_if(system.channels.begin(), system.channels.end(), [&](const auto& c) {
          return c.tracked_point == point && c.type == type && c.component == components[k];
        });
    if (found == system.channels.end()) return std::nullopt;
    out.columns[k] = static_cast<std::size_t>(found - system.channels.begin());
    out.scales[k] = unit_scale(type, found->units);
    out.frame = found->reference_frame;
  }
  return out;
}

/// The names of the tracked points, in the order of their first channels.
std::vector<std::string> tracked_points(const BidsSystem& system) {
  std::vector<std::string> out;
  std::set<std::string> known;
  // The channels of a point may stand anywhere in the table.
  for (const BidsChannel& channel : system.channels) {
    if (known.insert(channel.tracked_point).second) out.push_back(channel.tracked_point);
  }
  return out;
}

/// The conversion from a reference frame to kinalign's axes; y up if the frame's axes are unknown.
/// The result is empty if the frame's letters are not valid axes.
std::optional<Axes> axes_of_frame(const BidsSystem& system, const std::string& frame) {
  const auto letters = system.letters.find(frame);
  // A frame without letters is read as y up.
  if (letters == system.letters.end() || letters->second.value_or("n/a") == "n/a") return y_up;
  return axes_of_letters(*letters->second);
}

Result<Axes> space_of(const BidsSystem& system, const std::string& frame,
                      const StreamOptions& options) {
  const auto axes = axes_of_frame(system, frame);
  if (!axes && options.up.empty()) {
    return refuse("SpatialAxes of three letters, one of which is S or I; otherwise set up",
                  shown(*system.letters.at(frame)));
  }
  return axes_of(axes.value_or(y_up), options);
}

/// The column of the latencies; empty if there is none.
std::optional<std::size_t> latency_column(const BidsSystem& system) {
  const auto latency = std::find_if(system.channels.begin(), system.channels.end(),
                                    [](const BidsChannel& c) { return c.type == "LATENCY"; });
  if (latency == system.channels.end()) return std::nullopt;
  return static_cast<std::size_t>(latency - system.channels.begin());
}

/// Without latencies, the rate gives the times of rows, and the onset is the stamp of the first
/// row.
RowStamps stamps_of(const BidsSystem& system, const StreamOptions& options) {
  const bool latency = latency_column(system).has_value();
  const double rate = options.rate_hz > 0.0 ? options.rate_hz : system.rate_hz;
  auto start = options.start_ns;
  if (!start && !latency && system.onset) start = to_ns(*system.onset);
  return RowStamps(latency, rate, start);
}

/// Splits lines into numbers. For each wanted column, it stores the value, or that the value is
/// missing. Other columns are not parsed, because a motion.tsv may have hundreds of them.
class BidsRows {
 public:
  explicit BidsRows(const BidsSystem& system)
      : values(system.channels.size()),
        missing(system.channels.size()),
        wanted_(system.channels.size()),
        latency_(latency_column(system)),
        onset_ns_(system.onset ? to_ns(*system.onset) : 0) {}

  /// Marks the columns of a quantity as wanted, so that read() parses them.
  template <std::size_t n>
  void want(const Quantity<n>& quantity) {
    for (const std::size_t column : quantity.columns) wanted_[column] = true;
  }

  /// Reads a line into `values` and `missing`. Returns false for an empty line.
  Result<bool> read(std::string_view line) {
    if (trimmed(line).empty()) return false;
    std::size_t c = 0;
    for (;; ++c) {
      const auto tab = line.find('\t');
      if (c < values.size()) KA_TRY(read_cell(trimmed(line.substr(0, tab)), c));
      if (tab == std::string_view::npos) break;
      line.remove_prefix(tab + 1);
    }
    // A wrong number of cells would shift the columns.
    if (c + 1 == values.size()) return true;
    return refuse(fmt::format("{} cells, one per row of channels.tsv", values.size()),
                  std::to_string(c + 1));
  }

  /// The stamp of the row; 0 if the file has no latencies.
  Result<std::int64_t> stamp_ns() const {
    std::int64_t ns = 0;
    // The sum of onset and latency may overflow.
    if (latency_ && __builtin_add_overflow(onset_ns_, latency_ns_, &ns)) {
      return refuse("a stamp inside +-4e18 ns", "a stamp outside");
    }
    return ns;
  }

  std::vector<double> values;
  std::vector<std::uint8_t> missing;
  std::uint64_t nan_cells = 0;

 private:
  /// Parses cell c if it is the latency or belongs to a wanted column.
  Result<void> read_cell(std::string_view cell, std::size_t c) {
    if (latency_ && c == *latency_) {
      const auto ns = parse_stamp(cell, latency_seconds);
      if (!ns) return refuse("a latency in seconds", shown(cell));
      latency_ns_ = *ns;
      return {};
    }
    if (!wanted_[c]) return {};
    // BIDS requires n/a. Other marks for missing values are counted for a finding.
    missing[c] = cell == "n/a" || says_missing(cell) ? 1 : 0;
    if (missing[c] != 0) {
      nan_cells += cell == "n/a" ? 0 : 1;
      // A missing value becomes 0, so that it does not keep the value of the previous row.
      values[c] = 0.0;
      return {};
    }
    if (parse_number(cell, values[c]) && std::abs(values[c]) < largest_number) return {};
    return refuse("a number or n/a (motion.tsv has no line of column names)", shown(cell));
  }

  std::vector<bool> wanted_;
  std::optional<std::size_t> latency_;
  std::int64_t latency_ns_ = 0, onset_ns_;
};

/// The common part of both readers. Base is PointReader or ImuReader. The derived class converts
/// each row, in the order of the file.
template <class Base>
class BidsReader : public LineReader<Base> {
 public:
  using typename LineReader<Base>::Frames;

  BidsReader(const BidsSystem& system, const StreamOptions& options, std::string_view file)
      : LineReader<Base>(file, "rows of samples", stamps_of(system, options)), rows_(system) {
    this->header_.emplace();
  }

 protected:
  // Called when rows_.read() has filled the row.
  virtual void append_row(Frames& out) = 0;

  Result<void> report() override {
    if (rows_.nan_cells == 0) return {};
    add_warning(this->findings,
                {this->lines_.file(), 0, "n/a for what is missing",
                 fmt::format("{} cells that are empty or nan", rows_.nan_cells)},
                "these values are missing", "write n/a: validators of BIDS refuse other marks");
    return {};
  }

  BidsRows rows_;

 private:
  Result<void> read(std::string_view line, Frames& out) override {
    if (!KA_TRY(rows_.read(line))) return {};
    // The stamp is appended before the derived class appends the values.
    Frames& target = this->held_.target(this->stamps_, out);
    target.stamps.push_back(KA_TRY(this->stamps_.next(KA_TRY(rows_.stamp_ns()))));
    append_row(target);
    this->held_.release(this->stamps_, out);
    return {};
  }
};

struct TrackedPoint {
  std::string name;
  Quantity<3> places;
};

class BidsPointReader final : public BidsReader<PointReader> {
 public:
  BidsPointReader(const BidsSystem& system, const StreamOptions& options, std::string_view file,
                  std::vector<TrackedPoint> points, const Axes& axes)
      : BidsReader(system, options, file),
        points_(std::move(points)),
        units_(point_units({axes, 1.0}, options)),
        raw_(3 * points_.size()),
        states_(points_.size()) {
    for (const TrackedPoint& point : points_) {
      header_->joint_names.push_back(point.name);
      rows_.want(point.places);
    }
    // The user's unit replaces the units in the file, so the file's factors are set to 1.
    if (options.metres_per_unit > 0.0) {
      for (TrackedPoint& point : points_) point.places.scales = {1.0, 1.0, 1.0};
    }
  }

 private:
  /// Appends a row of points. A point is missing if one of its coordinates is missing.
  void append_row(PointFrames& out) override {
    for (std::size_t j = 0; j < points_.size(); ++j) {
      bool there = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t column = points_[j].places.columns[k];
        // A point needs all three coordinates.
        there = there && rows_.missing[column] == 0;
        raw_[3 * j + k] = points_[j].places.scales[k] * rows_.values[column];
      }
      states_[j] = there ? Tracking::tracked : Tracking::missing;
    }
    append_points(units_, raw_.data(), states_, out);
  }

  std::vector<TrackedPoint> points_;
  PointUnits units_;
  std::vector<double> raw_;       // [J,3] of the current row, in the file's axes
  std::vector<Tracking> states_;  // [J] of the current row
};

struct TrackedNode {
  std::string name;
  std::optional<Quantity<4>> orientation;
  std::optional<Quantity<3>> acceleration, angular_velocity;
};

/// Reads nodes. A quantity is read only if every node has it, because ImuContent describes all
/// nodes.
class BidsNodeReader final : public BidsReader<ImuReader> {
 public:
  BidsNodeReader(const BidsSystem& system, const StreamOptions& options, std::string_view file,
                 std::vector<TrackedNode> nodes, const Axes& axes)
      : BidsReader(system, options, file),
        nodes_(std::move(nodes)),
        samples_(ImuUnits{axes, 1.0, 1.0}) {
    const auto all = [this](const auto& has) {
      return std::all_of(nodes_.begin(), nodes_.end(), has);
    };
    header_->content = {all([](const TrackedNode& n) { return n.orientation.has_value(); }),
                        all([](const TrackedNode& n) { return n.acceleration.has_value(); }),
                        all([](const TrackedNode& n) { return n.angular_velocity.has_value(); }),
                        true};
    for (const TrackedNode& node : nodes_) {
      header_->node_names.push_back(node.name);
      if (header_->content.orientation) rows_.want(*node.orientation);
      if (header_->content.acceleration) rows_.want(*node.acceleration);
      if (header_->content.angular_velocity) rows_.want(*node.angular_velocity);
    }
  }

  const ImuContent& content() const { return header_->content; }

 private:
  /// Appends one sample for each node. A sample is invalid if one of its numbers is missing.
  void append_row(ImuSamples& out) override {
    for (const TrackedNode& node : nodes_) {
      bool valid = true;
      std::array<double, 4> turn{};
      std::array<double, 3> force{}, rate{};
      if (header_->content.orientation) take(*node.orientation, turn, valid);
      if (header_->content.acceleration) take(*node.acceleration, force, valid);
      if (header_->content.angular_velocity) take(*node.angular_velocity, rate, valid);
      // nullptr: the stream does not have this quantity.
      samples_.append({header_->content.orientation ? turn.data() : nullptr,
                       header_->content.acceleration ? force.data() : nullptr,
                       header_->content.angular_velocity ? rate.data() : nullptr, valid},
                      out);
    }
  }

  template <std::size_t n>
  void take(const Quantity<n>& quantity, std::array<double, n>& out, bool& valid) {
    // A missing number makes only the sample of this node invalid.
    for (std::size_t k = 0; k < n; ++k) {
      valid = valid && rows_.missing[quantity.columns[k]] == 0;
      out[k] = quantity.scales[k] * rows_.values[quantity.columns[k]];
    }
  }

  Result<void> report() override {
    KA_TRY(BidsReader::report());
    samples_.report(lines_.file(), findings);
    return {};
  }

  std::vector<TrackedNode> nodes_;
  ImuConverter samples_;
};

/// Fails if the unit of a channel is not allowed for its type.
template <std::size_t n>
Result<void> check_unit(const BidsSystem& system, const Quantity<n>& quantity) {
  for (std::size_t k = 0; k < n; ++k) {
    if (quantity.scales[k] > 0.0) continue;
    const BidsChannel& channel = system.channels[quantity.columns[k]];
    return refuse("a unit of " + channel.type + " for channel " + shown(channel.name),
                  shown(channel.units));
  }
  return {};
}

/// Makes a reader of all tracked points that have x, y and z. Other points are skipped. All points
/// must have the same reference frame.
Result<std::unique_ptr<PointReader>> points_of(const BidsSystem& system,
                                               const StreamOptions& options,
                                               std::string_view file) {
  std::vector<TrackedPoint> points;
  for (const std::string& name : tracked_points(system)) {
    const auto places = find_quantity(system, name, "POS", bids_axes);
    if (!places) continue;
    // If the user gave metres_per_unit, the unit in the file does not matter.
    if (options.metres_per_unit <= 0.0) KA_TRY(check_unit(system, *places));
    // Positions in two frames can't be combined, because BIDS does not state the transform between
    // frames.
    if (!points.empty() && points.front().places.frame != places->frame) {
      return refuse("one reference_frame for all POS channels", shown(places->frame));
    }
    points.push_back({name, *places});
  }
  if (points.empty()) return refuse("POS channels x, y and z of a tracked point", "none");
  const Axes axes = KA_TRY(space_of(system, points.front().places.frame, options));
  return std::make_unique<BidsPointReader>(system, options, file, std::move(points), axes);
}

/// Makes a reader of all tracked points with an orientation, an acceleration or an angular
/// velocity.
Result<std::unique_ptr<ImuReader>> nodes_of(const BidsSystem& system, const StreamOptions& options,
                                            std::string_view file) {
  std::vector<TrackedNode> nodes;
  Axes axes = y_up;
  for (const std::string& name : tracked_points(system)) {
    TrackedNode node{name, find_quantity(system, name, "ORNT", bids_quaternion),
                     find_quantity(system, name, "ACCEL", bids_axes),
                     find_quantity(system, name, "GYRO", bids_axes)};
    if (node.acceleration) KA_TRY(check_unit(system, *node.acceleration));
    if (node.angular_velocity) KA_TRY(check_unit(system, *node.angular_velocity));
    // The frame of the orientations is the world. Vectors are in sensor space.
    if (node.orientation) axes = KA_TRY(space_of(system, node.orientation->frame, options));
    // A quaternion has no unit, so a unit in the table is ignored.
    if (node.orientation) node.orientation->scales = {1.0, 1.0, 1.0, 1.0};
    if (node.orientation || node.acceleration || node.angular_velocity)
      nodes.push_back(std::move(node));
  }
  if (nodes.empty()) return refuse("ORNT channels of a quaternion, ACCEL or GYRO channels", "none");
  // In a left-handed space, an orientation is not a rotation.
  if (determinant(axes) != 1) {
    return refuse("orientations in a right-handed space", "left-handed SpatialAxes");
  }
  auto reader = std::make_unique<BidsNodeReader>(system, options, file, std::move(nodes), axes);
  const ImuContent& content = reader->content();
  // All nodes must have at least one quantity in common.
  if (content.orientation || content.acceleration || content.angular_velocity) return reader;
  return refuse("ORNT, ACCEL or GYRO of every node", "nodes without a common quantity");
}

}  // namespace

Result<std::unique_ptr<PointReader>> make_bids_point_reader(const BidsSystem& system,
                                                            const StreamOptions& options,
                                                            std::string_view file) {
  return points_of(system, options, file).map_error(in_file(std::string(file)));
}

Result<std::unique_ptr<ImuReader>> make_bids_node_reader(const BidsSystem& system,
                                                         const StreamOptions& options,
                                                         std::string_view file) {
  return nodes_of(system, options, file).map_error(in_file(std::string(file)));
}

}  // namespace kinalign
