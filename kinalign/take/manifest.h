// SPDX-License-Identifier: Apache-2.0
// The description of a recording and of its alignment. recording.toml, the flags of `kinalign
// align` and the parameters stored in a take all fill these structures. Documented for users in
// docs/formats/recording_toml.md.
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
  std::string path;  // the user's text, relative to the manifest
  std::string node;  // the node whose file it is; empty if the file names its nodes itself
};

/// The line at which a file states a key. Used in messages; also, a key that is stated must have an
/// effect, even with the default's value (align/unused_options.h).
using KeyLines = std::map<std::string, std::int64_t>;
/// 0 if no file states it.
std::int64_t line_of(const KeyLines& lines, const std::string& key);

/// How to read a stream, and what the user knows of its clock.
struct StreamOptions {
  std::string name;  // "mocap", "kinect", "imu": the group's name in the take
  std::vector<StreamFile> files;

  std::string layout;  // name or path of a declared layout; empty: by the file's content
  bool own_layout() const { return layout.ends_with(".toml"); }  // a file of the user's own
  std::string skeleton;  // for a recording: path of a BVH with the hierarchy of its poses
  std::map<std::string, std::string> select;  // chosen rows of a table: column -> value

  double metres_per_unit = 0.0;  // 0: the format's own (BVH: 0.01)
  std::string up;                // "y" or "z"; empty: the format's own (BVH: y)
  double rate_hz = 0.0;  // nominal, Hz: stamps rows without stamps, and sets the gap of others

  std::optional<std::int64_t> start_ns;  // stamp of the first frame; BVH: of the click on record
  std::optional<std::int64_t> end_ns;    // BVH: of the click on stop
  double click_latency_ms = 0.0;         // lambda: delay from a click to its effect

  std::string clock = "unknown";      // "shared": exact on the reference's clock; "unknown"
  double offset_ms = 0.0;             // added to the device's stamps
  double drift_ppm = 0.0;             // rate added from the first stamp on
  std::optional<double> interval_ms;  // half-width of the interval with the true time, if known

  std::map<std::string, std::vector<double>> mounting;  // for nodes: sensor_from_bone, w,x,y,z
  std::string root_node;  // for nodes: the node whose space all are brought into; empty: the
                          // world's

  KeyLines lines;
};

/// The way that a stream of points is brought into the reference's space.
struct SpaceOptions {
  std::string method = "none";      // none, paper, fit, given
  std::string onto;                 // the stream that gives the space; empty: the reference
  double rotation_y_deg = 60.0;     // paper, section 3.1: A_rot, counter-clockwise seen from +y
  double magnification = 1.0;       // paper: m
  std::vector<double> rotation;     // given: w,x,y,z
  std::vector<double> translation;  // given: m
  std::map<std::string, std::string> joints;           // this stream's joint -> the other stream's
  std::string root = "SpineBase", onto_root = "Hips";  // paper: the joints that coincide afterwards

  KeyLines lines;
};

struct AlignOptions {
  std::string reference;             // the stream whose stamps are the grid; empty: the first
  double gap_ms = 0.0;               // longest stretch to interpolate over; 0: 3.1 nominal steps
  std::string rotations = "spline";  // spline: twice continuously differentiable; slerp
  bool store_double = false;         // in the take: doubles instead of floats
};

struct Manifest {
  std::string subject, action;
  std::vector<StreamOptions> streams;
  std::map<std::string, SpaceOptions> spaces;  // by the stream's name
  AlignOptions align;
};

/// The stream's options; the defaults if the manifest has none.
const StreamOptions& options_of(const Manifest& manifest, const std::string& stream);

/// The places that name files: those of streams, layouts of the user's own, and skeletons.
std::vector<std::string*> paths_in(Manifest& manifest);

/// Fails if a take can't have a group of that name.
Result<void> check_stream_name(const std::string& name);

/// Names, meanings and ranges of the options, for flags, TOML, JSON and --help. All keys of a
/// manifest are here, except the tables themselves and a stream's `file` and `files`.
Fields describe(Manifest& manifest);
Fields describe(AlignOptions& options);
Fields describe(StreamOptions& options);
Fields describe(SpaceOptions& options);

}  // namespace kinalign
