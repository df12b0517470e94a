// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/ntu_skeleton.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/named_lines.h"
#include "kinalign/formats/point_rows.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/motion/kinect_joints.h"

#include <algorithm>
#include <charconv>

namespace kinalign {

namespace {

constexpr std::size_t joint_count = kinect_joints.size();
// Numbers of cells in a body's line and in a joint's line.
constexpr std::size_t body_cells = 10, joint_cells = 12;
constexpr std::uint64_t most_bodies = 1000;  // in a frame; the sensor tracks at most six

std::vector<ColumnUse> joint_columns() {
  std::vector<ColumnUse> uses(joint_cells);  // x y z depthX depthY colorX colorY qw qx qy qz state
  // Only x, y, z and the state are read.
  for (int i = 0; i < 3; ++i) uses[static_cast<std::size_t>(i)].slot = i;
  uses.back().slot = 3;
  return uses;
}

std::vector<std::string> joint_names() { return {kinect_joints.begin(), kinect_joints.end()}; }

Result<std::uint64_t> count(std::string_view line, std::string expected, std::uint64_t most) {
  const std::string_view text = trimmed(line);
  std::uint64_t value = 0;
  const auto [behind, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault == std::errc{} && behind == text.data() + text.size() && value <= most) return value;
  return Failure(Error{"", 0, std::move(expected), shown(text)});
}

std::string_view first_word(std::string_view line) {
  line = trimmed(line);
  return line.substr(0, line.find_first_of(" \t"));
}

/// Reads the file line by line; next_ is the kind of the next line.
/// Every line is read, also those of other bodies, because the counts must be followed.
class NtuReader final : public PointReader {
 public:
  NtuReader(const StreamOptions& options, std::string_view file)
      : lines_(file),
        // The file has no stamps. 30 Hz is the Kinect's rate.
        stamps_(false, options.rate_hz > 0.0 ? options.rate_hz : 30.0, options.start_ns),
        units_(point_units({}, options)),
        row_(runs_of_blanks, joint_columns()),
        mirror_(joint_names()) {
    const auto body = options.select.find("body");
    if (body != options.select.end()) wanted_ = body->second;
    // Without the option the first body of the file is read.
    asked_ = !wanted_.empty();
  }

  Result<void> feed(std::string_view piece, PointFrames& out) override {
    return lines_.feed(piece, [&](std::string_view line) { return read(line, out); });
  }

  Result<void> finish(PointFrames& out) override {
    const auto use = [&](std::string_view line) { return read(line, out); };
    KA_TRY(header_ ? lines_.finish(use, findings) : lines_.finish_head(use, findings));
    // Not even the first line was complete.
    if (!header_) return Failure(lines_.error("the number of frames", "the end of the file"));
    // The file has no time column, so its stamps are always counted.
    counted = true;
    report();
    return {};
  }

  const PointHeader* header() const override { return header_ ? &*header_ : nullptr; }

 private:
  enum class Next { frames, bodies, body, joints, joint };

  Result<void> read(std::string_view line, PointFrames& out) {
    // Blank lines may stand anywhere.
    if (trimmed(line).empty()) return {};
    switch (next_) {
      case Next::frames:
        declared_ = KA_TRY(count(line, "the number of frames", UINT64_MAX));
        // The joints of a Kinect are known, so the header is complete here.
        header_ = PointHeader{joint_names()};
        next_ = Next::bodies;
        return {};
      case Next::bodies:
        return begin_frame(KA_TRY(count(line, "the number of bodies", most_bodies)), out);
      case Next::body:
        return begin_body(line);
      case Next::joints:
        return begin_joints(KA_TRY(count(line, "25 joints", joint_count)));
      case Next::joint:
        return read_joint(line, out);
    }
    return {};
  }

  /// A frame begins: `bodies` bodies follow.
  Result<void> begin_frame(std::uint64_t bodies, PointFrames& out) {
    bodies_left_ = bodies;
    // Joints that the frame does not have stay missing.
    frame_ = {};
    seen_ = false;
    if (bodies == 0) return end_frame(out);
    next_ = Next::body;
    return {};
  }

  /// Reads a body's line. The joints after it are used only if it is the wanted body.
  Result<void> begin_body(std::string_view line) {
    const std::size_t cells = split_cells(line, runs_of_blanks).size();
    if (cells != body_cells) {
      return Failure(Error{"", 0, "10 cells of a body", std::to_string(cells)});
    }
    const std::string_view id = first_word(line);
    if (wanted_.empty()) wanted_ = id;
    // If an id occurs twice in a frame, the first one is taken.
    taken_ = id == wanted_ && !seen_;
    seen_ = seen_ || taken_;
    if (id != wanted_) note_other(id);
    next_ = Next::joints;
    return {};
  }

  void note_other(std::string_view id) {
    // The limit keeps a damaged file from filling the message.
    constexpr std::size_t most = 20;
    if (others_.size() >= most) return;
    if (std::find(others_.begin(), others_.end(), id) == others_.end())
      others_.push_back(shown(id));
  }

  Result<void> begin_joints(std::uint64_t number) {
    if (number != joint_count) return Failure(Error{"", 0, "25 joints", std::to_string(number)});
    joint_ = 0;
    next_ = Next::joint;
    return {};
  }

  /// Reads a joint's line. After the last joint of the last body, the frame is complete.
  Result<void> read_joint(std::string_view line, PointFrames& out) {
    KA_TRY(row_.read(line));
    const double state = row_.values[3];
    if (state != 0.0 && state != 1.0 && state != 2.0) {
      return Failure(Error{"", 0, "a tracking state 0, 1 or 2", shown(trimmed(line))});
    }
    // The rows of other bodies are parsed too, so a fault in them is found.
    if (taken_) {
      std::copy_n(row_.values.begin(), 3, &frame_.positions[3 * joint_]);
      frame_.states[joint_] = row_.any_missing ? Tracking::missing : static_cast<Tracking>(state);
    }
    if (++joint_ < joint_count) return {};
    // Another body may follow in this frame.
    next_ = Next::body;
    return --bodies_left_ == 0 ? end_frame(out) : Result<void>{};
  }

  Result<void> end_frame(PointFrames& out) {
    next_ = Next::bodies;
    const Time stamp = KA_TRY(stamps_.next(0));
    // A frame without the body is a row of missing joints.
    append_points(units_, frame_.positions.data(), frame_.states, out);
    out.stamps.push_back(stamp);
    mirror_.watch(frame_.positions.data(), frame_.states.data());
    frames_with_body_ += seen_ ? 1 : 0;
    return {};
  }

  /// The counts are complete now, so faults can be judged.
  void report() {
    const std::string& file = lines_.file();
    // The file ended within a frame.
    if (next_ != Next::bodies) {
      findings.push_back({Severity::warning,
                          Error{file, lines_.number(), "a complete frame", "the end of the file"},
                          "the last frame was dropped", ""});
    }
    if (stamps_.rows() != declared_) {
      findings.push_back(
          {Severity::warning,
           Error{file, 1, std::to_string(declared_) + " frames", std::to_string(stamps_.rows())},
           "the existing frames were read", ""});
    }
    // An id that the user gave must exist.
    if (asked_ && frames_with_body_ == 0) {
      findings.push_back({Severity::warning, Error{file, 0, "body " + shown(wanted_), others()},
                          "all joints are missing", "select an existing body"});
    } else if (!asked_ && !others_.empty()) {
      findings.push_back({Severity::note, Error{file, 0, "one body", "several: also " + others()},
                          "body " + shown(wanted_) + ", the first in the file, was read",
                          "to read another body, set body to its id"});
    }
    mirror_.report(file, findings);
  }

  std::string others() const {
    std::string list;
    for (const std::string& id : others_) list += (list.empty() ? "" : ", ") + id;
    return list.empty() ? "none" : list;
  }

  /// [J,3] in the file's axes and unit; joints start as missing unless the body is seen.
  struct Frame {
    std::array<double, 3 * joint_count> positions{};
    std::array<Tracking, joint_count> states{};
  };

  NamedLines lines_;
  RowStamps stamps_;
  PointUnits units_;
  RowParser row_;
  MirrorWatch mirror_;
  std::string wanted_;
  bool asked_ = false;
  std::vector<std::string> others_;

  // next_ and the counters below it are the state of the parser.
  Next next_ = Next::frames;
  std::uint64_t declared_ = 0, bodies_left_ = 0, frames_with_body_ = 0;
  std::size_t joint_ = 0;
  bool taken_ = false, seen_ = false;
  Frame frame_;
  std::optional<PointHeader> header_;
};

}  // namespace

std::unique_ptr<PointReader> make_ntu_skeleton_reader(const StreamOptions& options,
                                                      std::string_view file) {
  return std::make_unique<NtuReader>(options, file);
}

/// Checks the first four lines: frames, bodies, a body's cells, and 25 joints. The first frame may
/// have no body.
bool looks_like_ntu_skeleton(std::string_view head) {
  std::vector<std::string_view> first;
  while (first.size() < 4 && !head.empty()) {
    const auto end = head.find('\n');
    first.push_back(trimmed(head.substr(0, end)));
    head.remove_prefix(end == std::string_view::npos ? head.size() : end + 1);
  }
  // The first line must be a number.
  if (first.size() < 2 || !count(first[0], "", UINT64_MAX)) return false;
  const auto bodies = count(first[1], "", most_bodies);
  if (!bodies) return false;
  // A first frame without a body has no further lines.
  if (*bodies == 0) return first.size() == 2 || count(first[2], "", most_bodies).has_value();
  return first.size() == 4 && split_cells(first[2], runs_of_blanks).size() == body_cells &&
         first[3] == "25";
}

}  // namespace kinalign
