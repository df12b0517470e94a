// SPDX-License-Identifier: Apache-2.0
// A recording: what several devices said of one motion, stream by stream, each readable from its
// front in blocks as often as needed, so that no stream has to fit into memory.
#pragma once

#include "kinalign/clock/time_model.h"
#include "kinalign/core/error.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/stamps.h"
#include "kinalign/motion/streams.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

struct StreamOptions;

/// One pass over a stream: each call fills the next block (replacing what it held); false at the
/// end. Blocks are of the reader's size, never empty.
template <class Frames>
using Pass = std::function<Result<bool>(Frames&)>;

/// Starts a new pass from the front.
template <class Frames>
using Passes = std::function<Result<Pass<Frames>>()>;

struct ClipInput {
  Skeleton skeleton;
  Passes<ClipFrames> passes;
};

struct PointInput {
  std::vector<std::string> joint_names;
  Passes<PointFrames> passes;
};

struct ImuInput {
  std::vector<std::string> node_names;
  ImuContent content;
  Passes<ImuSamples> passes;
};

/// A file that a stream came from, as a take remembers it.
struct InputFacts {
  std::string name;    // as the manifest gives it; outside its folder the file's name only
  std::string sha256;  // 64 hexadecimal digits
  std::uint64_t bytes = 0;

  bool operator==(const InputFacts&) const = default;
};

/// That something happened while a recording was made: somebody or a program said so.
struct TakeMark {
  Time at{};
  std::string kind, text;           // "start", "stop", "t_pose", "text"
  std::optional<Duration> latency;  // from the mark to its effect
  std::string source;               // "keyboard", "call", "trigger"

  bool operator==(const TakeMark&) const = default;
};

/// A file that several streams are read from, such as a recording.
struct SharedFile {
  Findings findings;            // of the file as a whole
  std::vector<TakeMark> marks;  // in the order of their arrival
};

struct RecordedStream {
  std::string name;    // the take's group: "mocap", "kinect"; streams of nodes may share one, "imu"
  std::string format;  // what its file was read as: "bvh", a layout's name; empty: memory
  std::variant<ClipInput, PointInput, ImuInput> data;
  StampSurvey survey;  // of the device's stamps
  /// Of a file that states a fixed step instead of stamps: frame k is at first + k * step, rounded.
  std::optional<double> step_ns;
  /// The device wrote no stamps: they are counted from the first by a rate or that step.
  bool counted = false;
  TimeModel clock;  // from those to the take's axis
  std::vector<InputFacts> files;
  Findings findings;  // of the reader
  /// Of a stream that opening has not read through: findings about its values, absent until a pass
  /// has been read to its end. Copies of such a pass share their place. nullptr: none come.
  std::shared_ptr<std::optional<Findings>> late_findings;
  /// Of such a stream: the stamp of each row, in their order.
  std::shared_ptr<const std::vector<Time>> stamps;
  std::optional<std::size_t> shared_file;  // of the Recording, that it is read from
};

/// The stream's first and last stamp on the take's axis.
Time first_of(const RecordedStream& stream);
Time last_of(const RecordedStream& stream);

/// "kinect"; for a single node, whose streams share a name, "imu waist".
std::string stream_label(const RecordedStream& stream);

/// The usual step between samples in ns: the stated one, else the median. At most 30 years.
std::int64_t usual_step_ns(const RecordedStream& stream, const StreamOptions& options);

/// The reader's findings and, behind them, the late ones that have come.
Findings all_findings(const RecordedStream& stream);

struct Recording {
  std::string subject, action;  // empty where nothing is known
  std::vector<RecordedStream> streams;
  std::vector<SharedFile> shared_files{};
};

/// The shared file of that stream where no stream before it is read from it; else nullptr.
const SharedFile* newly_read_file(const Recording& recording, std::size_t stream);

/// One of several passes that are read side by side: reads its next block and returns the stamp of
/// the block's last sample on the take's axis, ns; absent behind the last block.
using ReadNext = std::function<Result<std::optional<std::int64_t>>()>;

/// Reads on where `pass` has come to, and counts its rows. `clock` and `rows` must outlive it.
template <class Frames>
ReadNext read_on(Pass<Frames> pass, const TimeModel& clock, std::uint64_t& rows) {
  return [pass = std::move(pass), &clock, &rows]() -> Result<std::optional<std::int64_t>> {
    Frames block;
    if (!KA_TRY(pass(block))) return std::optional<std::int64_t>();
    rows += block.size();
    return std::optional(to_ns(take_time(clock, block.stamps.back())));
  };
}

/// Reads all passes to their ends, always the one that has come least far: streams of one recording
/// then share its chunks. Calls `go` after each block, which may fail.
Result<void> read_side_by_side(const std::vector<ReadNext>& passes,
                               const std::function<Result<void>()>& go);

/// Streams that lie in memory: surveyed here, for tests and small jobs.
RecordedStream recorded(std::string name, Clip clip);
RecordedStream recorded(std::string name, PointStream points);
RecordedStream recorded(std::string name, ImuStream imu);

}  // namespace kinalign
