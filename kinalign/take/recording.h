// SPDX-License-Identifier: Apache-2.0
// A recording: the data of several devices about one motion. Each stream can be read in blocks from
// its beginning, as often as needed, so no stream must fit into memory.
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

/// One pass over a stream. Each call replaces the content of the block by the next rows and returns
/// true; at the end it returns false. The reader chooses the size of blocks. Blocks are never
/// empty.
template <class Frames>
using Pass = std::function<Result<bool>(Frames&)>;

/// Starts a new pass at the first row.
template <class Frames>
using Passes = std::function<Result<Pass<Frames>>()>;

/// The content of a stream of skeletons, points or nodes. `passes` may be called as often as
/// needed.
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

/// The facts about an input file that a take stores.
struct InputFacts {
  std::string name;    // relative to the manifest's folder; outside that folder only the file's
                       // name
  std::string sha256;  // 64 hexadecimal digits
  std::uint64_t bytes = 0;

  bool operator==(const InputFacts&) const = default;
};

/// A mark: a note by a person or a program that something happened during the recording.
struct TakeMark {
  Time at{};
  std::string kind, text;           // "start", "stop", "t_pose", "text"
  std::optional<Duration> latency;  // time from the mark to its effect
  std::string source;               // "keyboard", "call", "trigger"

  bool operator==(const TakeMark&) const = default;
};

/// A file that contains several streams, such as a recording.
struct SharedFile {
  Findings findings;            // findings about the whole file
  std::vector<TakeMark> marks;  // in the order of arrival
};

/// One stream of a recording, as alignment uses it. It contains facts about all samples. The values
/// are read by the passes of `data`.
struct RecordedStream {
  std::string name;    // the group in the take: "mocap", "kinect"; streams of nodes may share "imu"
  std::string format;  // the format: "bvh" or the name of a layout; empty: from memory
  std::variant<ClipInput, PointInput, ImuInput> data;
  StampSurvey survey;  // of the device's own stamps
  /// Set if the file states a fixed step instead of stamps. Frame k is at first + k * step,
  /// rounded.
  std::optional<double> step_ns;
  /// The device wrote no stamps. They are computed from the first stamp by the rate or by step_ns.
  bool counted = false;
  TimeModel clock;  // converts the device's stamps to the take's time axis
  std::vector<InputFacts> files;
  Findings findings;  // from the reader
  /// Findings about values, for a stream that is not read to its end when it is opened. The
  /// optional is empty until one pass reaches the end. Copies of the stream share it. nullptr: the
  /// stream has no such findings.
  std::shared_ptr<std::optional<Findings>> late_findings;
  /// Set for a stream with late findings: the stamps of all rows, in order.
  std::shared_ptr<const std::vector<Time>> stamps;
  std::optional<std::size_t> shared_file;  // index in Recording::shared_files
};

/// The stream's first and last stamp on the take's time axis.
Time first_of(const RecordedStream& stream);
Time last_of(const RecordedStream& stream);

/// Returns "kinect"; for a stream of a single node, "imu waist", since such streams share a name.
std::string stream_label(const RecordedStream& stream);

/// Returns the usual step between samples, ns: the stated step, or else the median. At most 30
/// years.
std::int64_t usual_step_ns(const RecordedStream& stream, const StreamOptions& options);

/// Returns the reader's findings, followed by the late findings that are known.
Findings all_findings(const RecordedStream& stream);

/// All streams of one motion. The first stream is the reference (its stamps are the grid), unless
/// the manifest names another stream. The take's groups have the order of the streams.
struct Recording {
  std::string subject, action;  // empty: not known
  std::vector<RecordedStream> streams;
  std::vector<SharedFile> shared_files{};
};

/// Returns the shared file of that stream if no earlier stream uses the same file; otherwise
/// nullptr.
const SharedFile* newly_read_file(const Recording& recording, std::size_t stream);

/// One of several passes that are read in parallel. Reads the next block and returns the stamp of
/// its last sample on the take's time axis, ns. Absent after the last block.
using ReadNext = std::function<Result<std::optional<std::int64_t>>()>;

/// Returns a function that continues `pass` block by block and counts its rows. `clock` and `rows`
/// must outlive the function. The values are not used; the pass is read for the findings of its
/// reader.
template <class Frames>
ReadNext read_on(Pass<Frames> pass, const TimeModel& clock, std::uint64_t& rows) {
  return [pass = std::move(pass), &clock, &rows]() -> Result<std::optional<std::int64_t>> {
    Frames block;
    if (!KA_TRY(pass(block))) return std::optional<std::int64_t>();
    rows += block.size();
    return std::optional(to_ns(take_time(clock, block.stamps.back())));
  };
}

/// Reads all passes to their ends, always the pass with the earliest stamp. Streams of one
/// recording then decode each chunk once. `go` is called after each block; its error ends the call.
Result<void> read_side_by_side(const std::vector<ReadNext>& passes,
                               const std::function<Result<void>()>& go);

}  // namespace kinalign
