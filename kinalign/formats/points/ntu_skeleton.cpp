// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/ntu_skeleton.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/line_reader.h"
#include "kinalign/formats/point_rows.h"
#include "kinalign/motion/kinect_joints.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t joint_count = kinect_joints.size();
// The numbers of cells in the line of a body and in the line of a joint.
constexpr std::size_t body_cells = 10, joint_cells = 12;
constexpr std::uint64_t most_bodies = 1000;  // per frame; the sensor tracks at most six

std::vector<ColumnUse> joint_columns() {
  std::vector<ColumnUse> uses(joint_cells);  // x y z depthX depthY colorX colorY qw qx qy qz state
  // Only x, y, z and the state are read.
  for (int i = 0; i < 3; ++i) uses[static_cast<std::size_t>(i)].slot = i;
  uses.back().slot = 3;
  return uses;
}

std::vector<std::string> joint_names() { return {kinect_joints.begin(), kinect_joints.end()}; }

Result<std::uint64_t> count(std::string_view text, std::string expected, std::uint64_t most) {
  std::uint64_t value = 0;
  if (parse_integer(text, value) && value <= most) return value;
  return refuse(std::move(expected), shown(text));
}

std::string_view first_word(std::string_view line) {
  line = trimmed(line);
  return line.substr(0, line.find_first_of(" \t"));
}

/// The kinds of lines. A line contains a count of frames, of a frame's bodies or of a body's
/// joints, or it describes a body or a joint. Blank lines may stand anywhere.
enum class NtuLine { blank, frames, bodies, body, joints, joint };

/// Determines the kind of each line. The lines do not name their kind, so it follows from the
/// counts in earlier lines.
class NtuLines {
 public:
  /// Fails if the line must be a count but is not a number.
  Result<NtuLine> next(std::string_view line) {
    line = trimmed(line);
    if (line.empty()) return NtuLine::blank;
    const NtuLine now = next_;
    if (now == NtuLine::frames) {
      frames_ = KA_TRY(count(line, "the number of frames", UINT64_MAX));
    }
    if (now == NtuLine::bodies) {
      bodies_left_ = KA_TRY(count(line, "the number of bodies", most_bodies));
    }
    if (now == NtuLine::joints) {
      joints_left_ = KA_TRY(count(line, "25 joints", joint_count));
      if (joints_left_ != joint_count) {
        return refuse("25 joints", std::to_string(joints_left_));
      }
      --bodies_left_;
    }
    if (now == NtuLine::joint) --joints_left_;
    next_ = now == NtuLine::body ? NtuLine::joints
            : joints_left_ > 0   ? NtuLine::joint
            : bodies_left_ > 0   ? NtuLine::body
                                 : NtuLine::bodies;
    return now;
  }

  /// The number of frames that the file states.
  std::uint64_t frames() const { return frames_; }
  /// True in the middle of a frame: the next line belongs to the current frame.
  bool within_frame() const { return next_ != NtuLine::frames && next_ != NtuLine::bodies; }

 private:
  NtuLine next_ = NtuLine::frames;
  std::uint64_t frames_ = 0, bodies_left_ = 0, joints_left_ = 0;
};

/// Reads the file. The lines of other bodies are read, too, because their counts determine the
/// kinds of later lines.
class NtuReader final : public LineReader<PointReader> {
 public:
  NtuReader(const StreamOptions& options, std::string_view file)
      // The file has no stamps. A Kinect has 30 frames per second.
      : LineReader(
            file, "the number of frames",
            RowStamps(false, options.rate_hz > 0.0 ? options.rate_hz : 30.0, options.start_ns)),
        units_(point_units({}, options)),
        row_(runs_of_blanks, joint_columns()),
        mirror_(joint_names()) {
    const auto body = options.select.find("body");
    if (body != options.select.end()) wanted_ = body->second;
    // Without the option, the first body of the file is read.
    asked_ = !wanted_.empty();
  }

 private:
  Result<void> read(std::string_view line, PointFrames& out) override {
    const NtuLine kind = KA_TRY(kinds_.next(line));
    // The joints of a Kinect are known, so the header is complete after the first line.
    if (kind == NtuLine::frames) header_ = PointHeader{joint_names()};
    if (kind == NtuLine::bodies) {
      // Joints that are absent from the frame stay missing.
      frame_ = {};
      seen_ = false;
    }
    if (kind == NtuLine::body) KA_TRY(begin_body(line));
    if (kind == NtuLine::joints) joint_ = 0;
    if (kind == NtuLine::joint) KA_TRY(read_joint(line));
    const bool counted_only = kind == NtuLine::blank || kind == NtuLine::frames;
    return counted_only || kinds_.within_frame() ? Result<void>{} : end_frame(out);
  }

  /// Reads the line of a body. The following joints are used only if it is the wanted body.
  Result<void> begin_body(std::string_view line) {
    const std::size_t cells = split_cells(line, runs_of_blanks).size();
    if (cells != body_cells) {
      return refuse("10 cells of a body", std::to_string(cells));
    }
    const std::string_view id = first_word(line);
    if (wanted_.empty()) wanted_ = id;
    // If an id occurs twice in a frame, the first body with this id is read.
    taken_ = id == wanted_ && !seen_;
    seen_ = seen_ || taken_;
    if (id != wanted_) note_other(id);
    return {};
  }

  void note_other(std::string_view id) {
    // The limit keeps the message short if the file is damaged.
    constexpr std::size_t most = 20;
    if (others_.size() >= most) return;
    if (std::find(others_.begin(), others_.end(), id) == others_.end())
      others_.push_back(shown(id));
  }

  Result<void> read_joint(std::string_view line) {
    KA_TRY(row_.read(line));
    const double state = row_.values[3];
    if (state != 0.0 && state != 1.0 && state != 2.0) {
      return refuse("a tracking state 0, 1 or 2", shown(trimmed(line)));
    }
    // The joints of other bodies are parsed, too, so that faults in them are found.
    if (taken_) {
      std::copy_n(row_.values.begin(), 3, &frame_.positions[3 * joint_]);
      frame_.states[joint_] = row_.any_missing ? Tracking::missing : static_cast<Tracking>(state);
    }
    ++joint_;
    return {};
  }

  Result<void> end_frame(PointFrames& out) {
    const Time stamp = KA_TRY(stamps_.next(0));
    // If the body is not in the frame, the row has only missing joints.
    append_points(units_, frame_.positions.data(), frame_.states, out);
    out.stamps.push_back(stamp);
    mirror_.watch(frame_.positions.data(), frame_.states.data());
    frames_with_body_ += seen_ ? 1 : 0;
    return {};
  }

  /// Adds findings. At the end of the file all counts are complete.
  Result<void> report() override {
    const std::string& file = lines_.file();
    // The file ended in the middle of a frame.
    if (kinds_.within_frame()) {
      add_warning(findings, {file, lines_.number(), "a complete frame", "the end of the file"},
                  "the last frame was dropped");
    }
    if (stamps_.rows() != kinds_.frames()) {
      add_warning(
          findings,
          {file, 1, std::to_string(kinds_.frames()) + " frames", std::to_string(stamps_.rows())},
          "the existing frames were read");
    }
    // The user gave an id that is not in the file.
    if (asked_ && frames_with_body_ == 0) {
      add_warning(findings, {file, 0, "body " + shown(wanted_), others()}, "all joints are missing",
                  "select an existing body");
    } else if (!asked_ && !others_.empty()) {
      add_note(findings, {file, 0, "one body", "several: also " + others()},
               "body " + shown(wanted_) + ", the first in the file, was read",
               "to read another body, set body to its id");
    }
    mirror_.report(file, findings);
    return {};
  }

  std::string others() const {
    std::string list;
    for (const std::string& id : others_) list += (list.empty() ? "" : ", ") + id;
    return list.empty() ? "none" : list;
  }

  /// [J,3] positions in the file's axes and unit. All joints are missing until the body is found.
  struct Frame {
    std::array<double, 3 * joint_count> positions{};
    std::array<Tracking, joint_count> states{};
  };

  PointUnits units_;
  RowParser row_;
  MirrorWatch mirror_;
  std::string wanted_;
  bool asked_ = false;
  std::vector<std::string> others_;
  NtuLines kinds_;
  std::uint64_t frames_with_body_ = 0;
  std::size_t joint_ = 0;
  bool taken_ = false, seen_ = false;
  Frame frame_;
};

}  // namespace

std::unique_ptr<PointReader> make_ntu_skeleton_reader(const StreamOptions& options,
                                                      std::string_view file) {
  return std::make_unique<NtuReader>(options, file);
}

Result<std::vector<NtuBody>> ntu_bodies(const TextPieces& text, const std::string& name) {
  // The list is for a message or a menu. Only a damaged file has more bodies.
  constexpr std::size_t most_kept = 1000;
  std::vector<NtuBody> bodies;
  NamedLines lines(name);
  NtuLines kinds;
  const auto use = [&](std::string_view line) -> Result<void> {
    if (KA_TRY(kinds.next(line)) != NtuLine::body) return {};
    const std::string_view id = first_word(line);
    const auto at = std::find_if(bodies.begin(), bodies.end(),
                                 [&](const NtuBody& one) { return one.id == id; });
    // Further bodies are not listed, but the frames of listed bodies are still counted.
    if (at != bodies.end()) {
      ++at->frames;
    } else if (bodies.size() < most_kept) {
      bodies.push_back({std::string(id), 1});
    }
    return {};
  };
  for (;;) {
    const std::string_view piece = KA_TRY(text());
    if (piece.empty()) break;
    KA_TRY(lines.feed(piece, use));
  }
  Findings ignored;  // the reader of the file reports an incomplete end
  KA_TRY(lines.finish_head(use, ignored));
  // The sort is stable: bodies with the same number of frames keep the order of the file.
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const NtuBody& a, const NtuBody& b) { return a.frames > b.frames; });
  return bodies;
}

/// Checks the first four lines: the number of frames, the number of bodies, the cells of a body,
/// and 25 joints. The first frame may have no body.
bool looks_like_ntu_skeleton(std::string_view head) {
  std::vector<std::string_view> first;
  while (first.size() < 4 && !head.empty()) {
    const auto end = head.find('\n');
    first.push_back(trimmed(head.substr(0, end)));
    head.remove_prefix(end == std::string_view::npos ? head.size() : end + 1);
  }
  // The first line must be the number of frames.
  if (first.size() < 2 || !count(first[0], "", UINT64_MAX)) return false;
  const auto bodies = count(first[1], "", most_bodies);
  if (!bodies) return false;
  // If the first frame has no body, the next line is the count of the second frame.
  if (*bodies == 0) return first.size() == 2 || count(first[2], "", most_bodies).has_value();
  return first.size() == 4 && split_cells(first[2], runs_of_blanks).size() == body_cells &&
         first[3] == "25";
}

}  // namespace kinalign
