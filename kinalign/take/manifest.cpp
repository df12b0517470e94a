// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/manifest.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace kinalign {

namespace {
// The limit of options in milliseconds. Longer gaps or delays come from a wrong unit.
constexpr double day_ms = 86'400'000.0;
}  // namespace

std::int64_t line_of(const KeyLines& lines, const std::string& key) {
  const auto found = lines.find(key);
  return found == lines.end() ? 0 : found->second;
}

// A recording may have streams that the manifest does not name, so an unknown name is not an error.
const StreamOptions& options_of(const Manifest& manifest, const std::string& stream) {
  static const StreamOptions defaults;
  for (const StreamOptions& s : manifest.streams) {
    if (s.name == stream) return s;
  }
  return defaults;
}

/// The pointers refer to the manifest itself, so that a caller can change the paths. They are valid
/// until the manifest's lists change.
std::vector<std::string*> paths_in(Manifest& manifest) {
  std::vector<std::string*> paths;
  for (StreamOptions& stream : manifest.streams) {
    for (StreamFile& file : stream.files) paths.push_back(&file.path);
    if (stream.own_layout()) paths.push_back(&stream.layout);
    if (!stream.skeleton.empty()) paths.push_back(&stream.skeleton);
  }
  return paths;
}

Result<void> check_stream_name(const std::string& name) {
  // Names of the data sets and attributes of a take itself (docs/formats/take.md), and the two
  // names that mean folders in HDF5.
  constexpr std::array<std::string_view, 7> taken{
      "time_ns", "seconds", "t0_ns", "report_json", "parameters_json", ".", ".."};
  const bool good = !name.empty() && name.find('/') == std::string::npos &&
                    name.find('\0') == std::string::npos &&
                    std::find(taken.begin(), taken.end(), name) == taken.end();
  if (good) return {};
  return Failure(Error{"", 0, "a stream's name that can be a group of the take",
                       name.empty() ? "an empty name" : "\"" + shown(name) + "\""});
}

Fields describe(Manifest& o) {
  return {{"subject", "who moves", &o.subject}, {"action", "what the person does", &o.action}};
}

/// The ranges below keep stamps with their offsets within 64 bits of nanoseconds.
Fields describe(AlignOptions& o) {
  return {
      {"reference", "stream whose stamps are the take's grid (default: the first)", &o.reference},
      {"gap_ms", "longest stretch without samples to interpolate over, ms; 0: 3.1 nominal periods",
       &o.gap_ms, 0.0, day_ms},
      {.name = "rotations",
       .meaning = "between samples: spline (no jump in angular acceleration) or slerp",
       .value = &o.rotations,
       .choices = {"spline", "slerp"}},
      {"double", "store 8-byte numbers instead of 4-byte ones", &o.store_double},
  };
}

Fields describe(StreamOptions& o) {
  return {
      {"select", "rows of a table that holds several bodies: column = value", &o.select},
      {.name = "mounting",
       .meaning = "how nodes are worn: the rotation from the bone's axes to the sensor's, w,x,y,z",
       .value = &o.mounting,
       .count = 4},
      {"layout", "name or path of a declared layout (default: by the file's content)", &o.layout},
      {"skeleton", "of recorded mocap: a BVH with its hierarchy (default: the recording's own)",
       &o.skeleton},
      {"metres_per_unit", "length of the file's unit, m; 0: the format's own (BVH: 0.01)",
       &o.metres_per_unit, 0.0, 1000.0},
      {.name = "up",
       .meaning = "the file's up axis (BVH: y)",
       .value = &o.up,
       .choices = {"", "y", "z"}},
      {"rate_hz",
       "nominal sampling rate: gives stamps to files without stamps, and defines a gap in others",
       &o.rate_hz, 0.0, 1e6},
      {"start_ns", "stamp of the first frame (BVH: of the click on record), ns", &o.start_ns, -4e18,
       4e18},
      {"end_ns", "stamp of the click on stop, ns", &o.end_ns, -4e18, 4e18},
      {"click_latency_ms", "delay from a click to its effect, ms", &o.click_latency_ms, -day_ms,
       day_ms},
      {.name = "clock",
       .meaning = "shared: stamps are exact on the reference's clock; unknown",
       .value = &o.clock,
       .choices = {"shared", "unknown"}},
      {"offset_ms", "added to the stream's stamps, ms", &o.offset_ms, -1e12, 1e12},
      {"drift_ppm", "rate added to the stream's stamps from the first stamp on, ppm", &o.drift_ppm,
       -1e5, 1e5},
      {"interval_ms", "half-width of the interval that holds a stamp's true time, ms",
       &o.interval_ms, 1e-6, day_ms},
      {"root_node", "node whose space all nodes are moved into (default: the world's)",
       &o.root_node},
  };
}

Fields describe(SpaceOptions& o) {
  return {
      {.name = "method",
       .meaning =
           "none; paper: equations (1) and (2), root onto root in each frame; fit: one rigid "
           "transform by least squares; given",
       .value = &o.method,
       .choices = {"none", "paper", "fit", "given"}},
      {"onto", "stream whose space is used (default: the reference)", &o.onto},
      {"rotation_y_deg", "paper: turn about the y axis, counter-clockwise seen from above, degrees",
       &o.rotation_y_deg, -360.0, 360.0},
      {"magnification", "paper: m, a ratio of sizes", &o.magnification, 1e-6, 1e6},
      {"root", "paper: this stream's root joint", &o.root},
      {"onto_root", "paper: the other stream's root joint", &o.onto_root},
      {.name = "rotation", .meaning = "given: w,x,y,z", .value = &o.rotation, .count = 4},
      {.name = "translation",
       .meaning = "given: m",
       .value = &o.translation,
       .least = -1e9,
       .most = 1e9,
       .count = 3},
      {"joints", "this stream's joint = the other stream's joint", &o.joints},
  };
}

}  // namespace kinalign
