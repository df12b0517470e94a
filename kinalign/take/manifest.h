// SPDX-License-Identifier: Apache-2.0
// What a user says of a recording and of how it shall be aligned: recording.toml, the flags of
// `kinalign align`, and the parameters that a take remembers are these structures.
// Documented for users in docs/formats/recording_toml.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// One file of a stream, or one node's file of a stream of nodes.
struct StreamFile {
  std::string path;  // as the user named it, relative to the manifest
  std::string node;  // the node worn at this place; empty where the file names its own
};

/// Where a file says a key: key -> line. For messages, and because a key that is said, if only with
/// the default's value, must have an effect (align/unused_options.h).
using KeyLines = std::map<std::string, std::int64_t>;
/// 0 where no file says it.
std::int64_t line_of(const KeyLines& lines, const std::string& key);

/// How to read a stream and what is known of its clock.
struct StreamOptions {
  std::string name;  // "mocap", "kinect", "imu": the take's group
  std::vector<StreamFile> files;

  std::string layout;  // name or path of a declared layout; empty: by the file's content
  bool own_layout() const { return layout.ends_with(".toml"); }  // a file of the user's
  std::string skeleton;  // of a recording: path of a BVH whose hierarchy its poses have
  std::map<std::string, std::string> select;  // rows of a table to take: column -> value

  double metres_per_unit = 0.0;  // 0: the format's own (BVH: 0.01)
  std::string up;                // "y" or "z"; empty: the format's own (BVH: y)
  double rate_hz = 0.0;          // nominal: stamps rows without any, and sets the gap of others

  std::optional<std::int64_t> start_ns;  // stamp of the first frame; BVH: the click on record
  std::optional<std::int64_t> end_ns;    // BVH: the click on stop
  double click_latency_ms = 0.0;         // lambda: from a click to its effect

  std::string clock = "unknown";      // "shared": with the reference, no doubt; "unknown"
  double offset_ms = 0.0;             // added to the device's stamps
  double drift_ppm = 0.0;             // and this rate, from the first stamp on
  std::optional<double> interval_ms;  // half-width that holds the truth, where known

  std::map<std::string, std::vector<double>> mounting;  // of nodes: sensor_from_bone, w,x,y,z
  std::string root_node;  // of nodes: all are brought into this one's space; empty: the world's

  KeyLines lines;
};

/// How a stream of points is brought into the reference's space.
struct SpaceOptions {
  std::string method = "none";      // none, paper, fit, given
  std::string onto;                 // the stream that gives the truth; empty: the reference
  double rotation_y_deg = 60.0;     // paper, section 3.1: A_rot, counter-clockwise seen from +y
  double magnification = 1.0;       // paper: m
  std::vector<double> rotation;     // given: w,x,y,z
  std::vector<double> translation;  // given: m
  std::map<std::string, std::string> joints;           // this stream's joint -> the other's
  std::string root = "SpineBase", onto_root = "Hips";  // paper: the joints that are put together

  KeyLines lines;
};

struct AlignOptions {
  std::string reference;             // whose stamps are the grid; empty: the first stream
  double gap_ms = 0.0;               // longest stretch to interpolate over; 0: 3.1 nominal steps
  std::string rotations = "spline";  // spline: twice continuously differentiable; slerp
  bool store_double = false;         // in the take; float otherwise
};

struct Manifest {
  std::string subject, action;
  std::vector<StreamOptions> streams;
  std::map<std::string, SpaceOptions> spaces;  // by stream
  AlignOptions align;
};

/// The stream's options; the defaults where the manifest has none.
const StreamOptions& options_of(const Manifest& manifest, const std::string& stream);

/// Where it names files: those of the streams, layouts of the user's own and skeletons.
std::vector<std::string*> paths_in(Manifest& manifest);

/// Fails where a take could not have a group of that name.
Result<void> check_stream_name(const std::string& name);

/// Names, meanings and ranges of the scalar options, for flags, TOML, JSON and --help.
Fields describe(AlignOptions& options);
Fields describe(StreamOptions& options);
Fields describe(SpaceOptions& options);

}  // namespace kinalign
