// SPDX-License-Identifier: Apache-2.0
// A recording: the data of several devices about one motion. Each stream can be read from its
// beginning in blocks, as often as needed, so no stream has to fit into memory.
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

/// One pass over a stream. Each call replaces the content of the block by the next one and returns
/// true; it returns false at the end. Blocks have the reader's size and are never empty.
template <class Frames>
using Pass = std::function<Result<bool>(Frames&)>;

/// Starts a new pass from the front.
template <class Frames>
using Passes = std::function<Result<Pass<Frames>>()>;

/// The content of a stream by its kind. `passes` may be called as often as needed; each pass begins
/// at the first row.
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
  std::string name;    // relative to the manifest's folder; for a file outside it the file's name
                       // only
  std::string sha256;  // 64 hexadecimal digits
  std::uint64_t bytes = 0;

  bool operator==(const InputFacts&) const = default;
};

/// A mark: a person or a program stated that something happened during the recording.
struct TakeMark {
  Time at{};
  std::string kind, text;           // "start", "stop", "t_pose", "text"
  std::optional<Duration> latency;  // from the mark to its effect
  std::string source;               // "keyboard", "call", "trigger"

  bool operator==(const TakeMark&) const = default;
};

/// A file with several streams, such as a recording.
struct SharedFile {
  Findings findings;            // about the file as a whole
  std::vector<TakeMark> marks;  // in the order of their arrival
};

/// One stream of a recording, as the aligner sees it. It holds facts about all samples; the values
/// come from the passes of `data`.
struct RecordedStream {
  std::string name;    // the take's group: "mocap", "kinect"; streams of nodes may share one, "imu"
  std::string format;  // the format read: "bvh", a layout's name; empty: memory
  std::variant<ClipInput, PointInput, ImuInput> data;
  StampSurvey survey;  // on the device's stamps
  /// Set if the file states a fixed step instead of stamps: frame k is at first + k * step,
  /// rounded.
  std::optional<double> step_ns;
  /// The device wrote no stamps; they are counted from the first one by a rate or by step_ns.
  bool counted = false;
  TimeModel clock;  // from the device's stamps to the take's axis
  std::vector<InputFacts> files;
  Findings findings;  // from the reader
  /// Findings about values, for a stream that opening does not read through. The optional is empty
  /// until a pass was read to its end; copies of the stream share it. nullptr: there are none.
  std::shared_ptr<std::optional<Findings>> late_findings;
  /// For such a stream: the stamps of all rows, in order.
  std::shared_ptr<const std::vector<Time>> stamps;
  std::optional<std::size_t> shared_file;  // index in Recording::shared_files
};

/// The stream's first and last stamp on the take's axis.
Time first_of(const RecordedStream& stream);
Time last_of(const RecordedStream& stream);

/// "kinect"; for a single node, whose streams share a name, "imu waist".
std::string stream_label(const RecordedStream& stream);

/// The usual step between samples, ns: the stated one, else the median. At most 30 years.
std::int64_t usual_step_ns(const RecordedStream& stream, const StreamOptions& options);

/// The reader's findings, then the late ones that are known.
Findings all_findings(const RecordedStream& stream);

/// All streams of one motion. The first stream is the reference unless the manifest names another
/// one. The take's groups are in the order of the streams.
struct Recording {
  std::string subject, action;  // empty if not known
  std::vector<RecordedStream> streams;
  std::vector<SharedFile> shared_files{};
};

/// The shared file of that stream, if no stream before it uses the same file; else nullptr.
const SharedFile* newly_read_file(const Recording& recording, std::size_t stream);

/// One of several passes that are read in parallel. Reads the next block and returns the stamp of
/// its last sample on the take's axis, ns; absent after the last block.
using ReadNext = std::function<Result<std::optional<std::int64_t>>()>;

/// Continues `pass` block by block and counts its rows. `clock` and `rows` must outlive it. The
/// values are dropped; the pass is read for what its reader finds on the way.
template <class Frames>
ReadNext read_on(Pass<Frames> pass, const TimeModel& clock, std::uint64_t& rows) {
  return [pass = std::move(pass), &clock, &rows]() -> Result<std::optional<std::int64_t>> {
    Frames block;
    if (!KA_TRY(pass(block))) return std::optional<std::int64_t>();
    rows += block.size();
    return std::optional(to_ns(take_time(clock, block.stamps.back())));
  };
}

/// Reads all passes to their ends, always the one that is furthest behind: streams of one recording
/// then share its chunks. Calls `go` after each block, which may fail.
Result<void> read_side_by_side(const std::vector<ReadNext>& passes,
                               const std::function<Result<void>()>& go);

}  // namespace kinalign
