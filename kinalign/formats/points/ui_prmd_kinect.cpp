// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/ui_prmd_kinect.h"

#include "kinalign/core/files.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/line_reader.h"
#include "kinalign/formats/point_rows.h"

#include <cassert>
#include <deque>
#include <numbers>

namespace kinalign {

namespace {

// The cells of a row: three numbers for each joint.
constexpr std::size_t cells = 3 * ui_prmd_joints;

constexpr std::array<std::string_view, ui_prmd_joints> names{
    "Waist",        "Spine",         "Chest",        "Neck",          "Head",
    "HeadTip",      "CollarLeft",    "UpperArmLeft", "ForearmLeft",   "HandLeft",
    "CollarRight",  "UpperArmRight", "ForearmRight", "HandRight",     "UpperLegLeft",
    "LowerLegLeft", "FootLeft",      "ToesLeft",     "UpperLegRight", "LowerLegRight",
    "FootRight",    "ToesRight"};

// Parents as indices into `names`. Each parent comes before its children.
constexpr std::array<int, ui_prmd_joints> parents{-1, 0,  1,  2, 3,  4,  2,  6, 7,  8,  2,
                                                  10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

RowParser numbers_parser() {
  std::vector<ColumnUse> uses(cells);
  for (std::size_t i = 0; i < cells; ++i) uses[i].slot = static_cast<int>(i);
  return {',', std::move(uses)};
}

Quat rotation(const double* degrees) {
  constexpr double degree = std::numbers::pi / 180.0;
  return Eigen::AngleAxisd(degrees[2] * degree, Vec3::UnitZ()) *
         Eigen::AngleAxisd(degrees[0] * degree, Vec3::UnitX()) *
         Eigen::AngleAxisd(degrees[1] * degree, Vec3::UnitY());
}

/// Returns the rows of the file of angles, one at a time. It reads a piece of this file only when
/// the rows of the other file need it, so both advance together.
class AngleRows {
 public:
  AngleRows(std::string_view file, TextPieces pieces)
      : lines_(file), pieces_(std::move(pieces)), row_(numbers_parser()) {}

  /// Reads the next row. Returns false at the end.
  Result<bool> next(std::vector<double>& angles) {
    // A piece may contain no complete row.
    while (rows_.empty() && !ended_) {
      const std::string_view piece = KA_TRY(pieces_());
      const auto use = [this](std::string_view line) { return read(line); };
      ended_ = piece.empty();
      KA_TRY(ended_ ? lines_.finish(use, findings) : lines_.feed(piece, use));
    }
    if (rows_.empty()) return false;
    angles = std::move(rows_.front());
    rows_.pop_front();
    return true;
  }

  Findings findings;

 private:
  Result<void> read(std::string_view line) {
    if (trimmed(line).empty()) return {};
    KA_TRY(row_.read(line));
    // A missing angle can't be replaced.
    if (row_.any_missing) return refuse("66 angles", "an empty cell");
    rows_.push_back(row_.values);
    return {};
  }

  NamedLines lines_;
  TextPieces pieces_;
  RowParser row_;
  std::deque<std::vector<double>> rows_;  // rows that were parsed but not used yet
  bool ended_ = false;
};

/// Rotates the joints by 180 degrees about y. In the files z points towards the camera, but in a
/// Kinect's space z points away from the camera.
void turn_forward(std::vector<double>& places) {
  for (std::size_t j = 0; j < ui_prmd_joints; ++j) {
    places[3 * j] = -places[3 * j];
    places[3 * j + 2] = -places[3 * j + 2];
  }
}

/// Combines each row of offsets with the row of angles of the same number. If one file is longer,
/// its last rows are dropped.
class UiPrmdReader final : public LineReader<PointReader> {
 public:
  UiPrmdReader(const StreamOptions& options, std::string_view offsets_file,
               std::string_view angles_file, TextPieces angles)
      // The files have no stamps. A Kinect has 30 frames per second.
      : LineReader(
            offsets_file, "rows of 66 numbers",
            RowStamps(false, options.rate_hz > 0.0 ? options.rate_hz : 30.0, options.start_ns)),
        angles_file_(angles_file),
        angle_rows_(angles_file, std::move(angles)),
        units_(point_units({y_up, 0.01}, options)),
        row_(numbers_parser()) {}

 private:
  Result<void> report() override {
    // Further rows of angles have no offsets. They are only counted.
    auto more = KA_TRY(count_angles_left());
    append(findings, angle_rows_.findings);
    report_more(without_angles_, lines_.file(), angles_file_);
    report_more(more, angles_file_, lines_.file());
    return {};
  }

  Result<void> read(std::string_view line, PointFrames& out) override {
    if (trimmed(line).empty()) return {};
    KA_TRY(row_.read(line));
    if (row_.any_missing) return refuse("66 offsets", "an empty cell");
    if (!header_) header_ = PointHeader{{names.begin(), names.end()}};
    // The file of angles has ended.
    if (!KA_TRY(angle_rows_.next(angles_))) {
      ++without_angles_;
      return {};
    }
    const Time stamp = KA_TRY(stamps_.next(0));
    // The positions are first computed in the files' axes and unit, then rotated and converted.
    ui_prmd_places(row_.values, angles_, places_);
    turn_forward(places_);
    append_points(units_, places_.data(), states_, out);
    out.stamps.push_back(stamp);
    return {};
  }

  Result<std::uint64_t> count_angles_left() {
    std::uint64_t left = 0;
    while (KA_TRY(angle_rows_.next(angles_))) ++left;
    return left;
  }

  void report_more(std::uint64_t rows, const std::string& file, const std::string& other) {
    if (rows == 0) return;
    add_warning(findings,
                {file, 0, "as many rows as in " + std::string(file_name(other)),
                 std::to_string(rows) + " more"},
                "the other rows were dropped");
  }

  std::string angles_file_;
  AngleRows angle_rows_;
  PointUnits units_;
  RowParser row_;
  std::uint64_t without_angles_ = 0;
  std::vector<double> angles_;
  std::vector<double> places_ = std::vector<double>(cells);
  // The files do not say whether a joint was seen.
  std::vector<Tracking> states_ = std::vector<Tracking>(ui_prmd_joints, Tracking::tracked);
};

}  // namespace

void ui_prmd_places(std::span<const double> offsets, std::span<const double> angles,
                    std::span<double> places) {
  assert(offsets.size() == cells && angles.size() == cells && places.size() == cells);
  std::array<Quat, ui_prmd_joints> global;
  // A parent comes before its children, so one loop is enough.
  for (std::size_t j = 0; j < ui_prmd_joints; ++j) {
    const Quat local = rotation(&angles[3 * j]);
    const Vec3 offset = vec3(offsets, j);
    if (parents[j] < 0) {
      global[j] = local;
      // The first offset is the position in camera space.
      vec3(places, j) = offset;
      continue;
    }
    const auto p = static_cast<std::size_t>(parents[j]);
    const Vec3 place = vec3(places, p) + global[p] * offset;
    vec3(places, j) = place;
    global[j] = global[p] * local;
  }
}

std::unique_ptr<PointReader> make_ui_prmd_kinect_reader(const StreamOptions& options,
                                                        std::string_view offsets_file,
                                                        std::string_view angles_file,
                                                        TextPieces angles) {
  return std::make_unique<UiPrmdReader>(options, offsets_file, angles_file, std::move(angles));
}

bool looks_like_ui_prmd_kinect(std::string_view head) {
  const auto end = head.find('\n');
  // A copy is needed, because parse_number() reads the character after a number.
  const std::string line(trimmed(head.substr(0, end)));
  RowParser row = numbers_parser();
  return row.read(line) && !row.any_missing;
}

}  // namespace kinalign
