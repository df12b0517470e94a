// SPDX-License-Identifier: Apache-2.0
// The description of a recording and of its alignment. recording.toml, the flags of `kinalign
// align` and the parameters in a take set these structures. The user's page is
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

/// One file of a stream. In a stream of nodes it may be the file of one node.
struct StreamFile {
  std::string path;  // the user's text, relative to the manifest
  std::string node;  // the node of this file; empty if the file itself names its nodes
};

/// The line of the file at which each key is set. Messages use it. A key that is set must have an
/// effect, even if its value is the default (align/unused_options.h).
using KeyLines = std::map<std::string, std::int64_t>;
/// Returns the line of the key, or 0 if no file sets it.
std::int64_t line_of(const KeyLines& lines, const std::string& key);

/// How to read a stream, and what the user states about its clock.
struct StreamOptions {
  std::string name;  // "mocap", "kinect", "imu": the name of the group in the take
  std::vector<StreamFile> files;

  std::string layout;  // name of a layout or path of a layout file; empty: the format is recognised
  bool own_layout() const { return layout.ends_with(".toml"); }  // a layout file of the user
  std::string skeleton;  // for a recording: path of a BVH with the hierarchy of the poses
  std::map<std::string, std::string> select;  // selected rows of a table: column -> value

  double metres_per_unit = 0.0;  // 0: the unit of the format (BVH: 0.01)
  std::string up;                // "y" or "z"; empty: the axis of the format (BVH: y)
  // Nominal rate, Hz. Rows without stamps get their stamps from it; other streams their longest
  // gap.
  double rate_hz = 0.0;

  std::optional<std::int64_t> start_ns;  // stamp of the first frame; BVH: of the click on record
  std::optional<std::int64_t> end_ns;    // BVH: stamp of the click on stop
  double click_latency_ms = 0.0;         // lambda: delay from a click to its effect

  std::string clock = "unknown";      // "shared": the same clock as the reference; or "unknown"
  double offset_ms = 0.0;             // added to the device's stamps
  double drift_ppm = 0.0;             // rate added from the first stamp on
  std::optional<double> interval_ms;  // half-width of the interval that contains the true time

  // for nodes: the rotation sensor_from_bone by node name, w,x,y,z
  std::map<std::string, std::vector<double>> mounting;
  std::string root_node;  // for nodes: the node to whose space all are converted; empty: the world

  KeyLines lines;
};

/// How a stream of points is moved into the space of the reference. The methods are "none", "paper"
/// (of the HFUT-MMD paper, section 3.1), "fit" and "given".
struct SpaceOptions {
  std::string method = "none";      // "none", "paper", "fit" or "given"
  std::string onto;                 // the stream onto which points are moved; empty: the reference
  double rotation_y_deg = 60.0;     // paper: A_rot, counter-clockwise seen from +y
  double magnification = 1.0;       // for method paper: the factor m
  std::vector<double> rotation;     // for method given: w,x,y,z
  std::vector<double> translation;  // given: m
  std::map<std::string, std::string> joints;           // joint of this stream -> joint of `onto`
  std::string root = "SpineBase", onto_root = "Hips";  // for method paper: put onto each other

  KeyLines lines;
};

struct AlignOptions {
  std::string reference;             // the stream whose stamps are the grid; empty: the first one
  double gap_ms = 0.0;               // longest gap to interpolate; 0: 3.1 nominal steps
  std::string rotations = "spline";  // spline (twice continuously differentiable) or slerp
  bool store_double = false;         // the take contains doubles instead of floats
};

struct Manifest {
  std::string subject, action;
  std::vector<StreamOptions> streams;
  std::map<std::string, SpaceOptions> spaces;  // by the stream's name
  AlignOptions align;
};

/// Returns the stream's options, or the defaults if the manifest has none.
const StreamOptions& options_of(const Manifest& manifest, const std::string& stream);

/// Returns pointers to all paths in the manifest: files of streams, layout files and skeletons.
std::vector<std::string*> paths_in(Manifest& manifest);

/// Fails if a group of a take can't have that name.
Result<void> check_stream_name(const std::string& name);

/// Names, meanings and ranges of the options, for flags, TOML, JSON and --help. The lists contain
/// all keys of a manifest except the names of tables and a stream's `file` and `files`.
Fields describe(Manifest& manifest);
Fields describe(AlignOptions& options);
Fields describe(StreamOptions& options);
Fields describe(SpaceOptions& options);

}  // namespace kinalign
