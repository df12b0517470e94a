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

/// What a file says, whichever of its streams is read.
struct SaidByFile {
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
  Findings findings;   // of the reader
  SaidByFile by_file;  // each stream that reads it has the same
};

/// The stream's first and last stamp on the take's axis.
Time first_of(const RecordedStream& stream);
Time last_of(const RecordedStream& stream);

/// "kinect"; for a single node, whose streams share a name, "imu waist".
std::string stream_label(const RecordedStream& stream);

/// The usual step between samples in ns: the stated one, else the median. At most 30 years.
std::int64_t usual_step_ns(const RecordedStream& stream, const StreamOptions& options);

struct Recording {
  std::string subject, action;  // empty where nothing is known
  std::vector<RecordedStream> streams;
};

/// Streams that lie in memory: surveyed here, for tests and small jobs.
RecordedStream recorded(std::string name, Clip clip);
RecordedStream recorded(std::string name, PointStream points);
RecordedStream recorded(std::string name, ImuStream imu);

}  // namespace kinalign
