// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs/quick.h"

#include "apps/cli/field_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/core/files.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace kinalign {

namespace {

/// A flag, the key of a manifest that means the same, and the flag without which this flag has no
/// meaning.
struct Twin {
  std::string_view flag, key, needs;
};

// The order matters for errors: the first flag in the table that does not fit is reported.
constexpr std::array<Twin, 15> twins{
    {{"mocap", "file in [stream.mocap]", ""},
     {"kinect", "file in [stream.kinect]", ""},
     {"imu", "files in [stream.imu]", ""},
     {"points", "file in [stream.NAME]", ""},
     {"mocap_layout", "layout in [stream.mocap]", "mocap"},
     {"kinect_layout", "layout in [stream.kinect]", "kinect"},
     {"points_layout", "layout in [stream.NAME]", "points"},
     {"imu_layout", "layout in [stream.imu]", "imu"},
     {"root_node", "root_node in [stream.imu]", "imu"},
     {"start_ns", "start_ns in [stream.mocap]", ""},
     {"metres_per_unit", "metres_per_unit in [stream.mocap]", ""},
     {"up", "up in [stream.mocap]", ""},
     {"space", "method in [space.kinect]", "kinect"},
     {"rotation_y_deg", "rotation_y_deg in [space.kinect]", "kinect"},
     {"joint", "joints in [space.kinect]", "kinect"}}};

/// True if the flag was given on the command line. A setting from a file or the environment never
/// contradicts a manifest.
bool is_given(std::string_view flag, const Sources& given) {
  const auto found = given.find(std::string(flag));
  return found != given.end() && found->second == Source::flag;
}

/// Fails if two streams have the same name: the take could not tell them apart.
Result<void> check_stream_names(const Manifest& manifest) {
  std::vector<std::string> names;
  for (const StreamOptions& stream : manifest.streams) {
    if (std::find(names.begin(), names.end(), stream.name) != names.end()) {
      return Failure(Error{"--points", 0, "a name that no other stream uses", shown(stream.name)});
    }
    names.push_back(stream.name);
  }
  return {};
}

/// The options of --space, with the pairs of joints from --joint.
Result<SpaceOptions> space_of(const QuickFlags& flags) {
  SpaceOptions space = flags.space;
  for (const std::string& joint : flags.joints) {
    const auto pair = KA_TRY(split_pair(joint, "KINECT=MOCAP").map_error(in_file("--joint")));
    // Each joint of the Kinect may be given once. Two of them may correspond to the same joint of
    // the mocap.
    if (!space.joints.insert(pair).second) {
      return Failure(
          Error{"--joint", 0, "each joint of the Kinect once", shown(pair.first) + " twice"});
    }
  }
  return space;
}

/// All nodes make one stream, "imu", with one file for each node.
Result<StreamOptions> nodes_of(const QuickFlags& flags) {
  StreamOptions nodes;
  // The user can't choose this name, because alignment puts all nodes into one group of the take.
  nodes.name = "imu";
  nodes.layout = flags.imu_layout;
  nodes.root_node = flags.root_node;
  for (const std::string& one : flags.imu) {
    const auto [node, file] = KA_TRY(split_pair(one, "NODE=FILE").map_error(in_file("--imu")));
    nodes.files.push_back({file, node});
  }
  return nodes;
}

/// The kinds of streams, as indices of the variant RecordedStream::data. Indices are compared and
/// not types, because a flag may allow two kinds.
constexpr std::size_t clip = 0, points = 1, nodes = 2;

/// The kinds of content that a flag's file may have. `expected`: their name in messages.
struct Wanted {
  std::string flag, path;
  std::vector<std::size_t> kinds;
  std::string expected;
};

/// The files of all flags. The order must be that of quick_manifest(), because check_kinds()
/// compares the flags and the streams one by one.
std::vector<Wanted> wanted_kinds(const QuickFlags& flags) {
  const std::vector<std::size_t> bodies{clip, points};
  // A mocap file may be a skeleton or points. A Kinect file is always points.
  std::vector<Wanted> out{{"--mocap", flags.mocap, bodies, "a skeleton's file or points"}};
  if (!flags.kinect.empty()) out.push_back({"--kinect", flags.kinect, {points}, "points"});
  const auto add = [&out](const std::string& flag, const std::string& pair,
                          const std::vector<std::size_t>& kinds, const std::string& expected) {
    const std::size_t equals = pair.find('=');
    out.push_back({flag + " " + pair.substr(0, equals), pair.substr(equals + 1), kinds, expected});
  };
  for (const std::string& one : flags.points) add("--points", one, bodies, "points");
  for (const std::string& one : flags.imu) add("--imu", one, {nodes}, "a file of nodes");
  return out;
}

}  // namespace

/// --space has the default "fit" here; in a manifest it has another default.
Fields QuickFlags::fields() {
  space.method = "fit";
  return {{"mocap", "the reference: a BVH, or a file of points", &mocap},
          {"kinect", "a file of Kinect joints", &kinect},
          {"imu", "a node's file; may be repeated", &imu},
          {"points", "a further file of points; may be repeated", &points},
          {"mocap_layout", "layout of the reference's file", &mocap_options.layout},
          {"kinect_layout", "layout of the Kinect file", &kinect_layout},
          {"points_layout", "layout of the further files of points", &points_layout},
          {"imu_layout", "layout of the nodes' files", &imu_layout},
          {"root_node", "node whose space all nodes are moved into", &root_node},
          {"start_ns", "stamp of the click that started the mocap, ns since 1970",
           &mocap_options.start_ns, -4e18, 4e18},
          {"metres_per_unit", "length of the mocap file's unit, m; 0: the format's own (BVH: 0.01)",
           &mocap_options.metres_per_unit, 0.0, 1000.0},
          choice_flag("up", "the mocap file's up axis (BVH: y)", &mocap_options.up, {"", "y", "z"}),
          choice_flag("space", "method that moves the Kinect into the mocap's space", &space.method,
                      {"none", "paper", "fit"}),
          {"rotation_y_deg", "with --space paper: rotation about the y axis, degrees",
           &space.rotation_y_deg, -360.0, 360.0},
          {"joint",
           "with --space: a joint of the Kinect and the same joint of the mocap; may be repeated",
           &joints}};
}

Result<void> refuse_with_input(const std::string& path, const Sources& given) {
  for (const Twin& twin : twins) {
    if (!is_given(twin.flag, given)) continue;
    // A recording has its own streams. The advice is to combine it with further files in a
    // recording.toml.
    if (path.ends_with(".mcap")) {
      const std::string key(twin.key.substr(0, twin.key.find('.')));
      return Failure(Error{flag_of(twin.flag), 0,
                           key + ".NAME] of a recording.toml, which can combine recordings and "
                                 "files (NAME: a stream's name, see kinalign info)",
                           shown(file_name(path)) + ", a recording, which already has streams"});
    }
    return Failure(Error{flag_of(twin.flag), 0, std::string(twin.key) + " of " + shown(path),
                         "this flag with a manifest"});
  }
  return {};
}

Result<void> refuse_alone(const QuickFlags& flags, const Sources& given) {
  for (const Twin& twin : twins) {
    // If `needs` is empty, the flag needs no other flag. check_use() in align.cpp checks --mocap.
    if (!is_given(twin.flag, given) || twin.needs.empty() || is_given(twin.needs, given)) continue;
    return Failure(Error{flag_of(twin.flag), 0,
                         flag_of(twin.needs) + ", to which this flag applies",
                         "no " + flag_of(twin.needs)});
  }
  // The table can't state the next two rules, because they depend on the value of a flag.
  if (is_given("rotation_y_deg", given) && flags.space.method != "paper") {
    return Failure(Error{"--rotation-y-deg", 0, "--space paper, to which this flag applies",
                         "--space " + flags.space.method});
  }
  if (!flags.joints.empty() && flags.space.method == "none") {
    return Failure(
        Error{"--joint", 0, "--space fit or paper, to which this flag applies", "--space none"});
  }
  return {};
}

Result<Manifest> quick_manifest(const QuickFlags& flags) {
  Manifest manifest;
  // `stream` is a copy of options: the layout and, for mocap, also start, unit and axis.
  const auto add = [&manifest](StreamOptions stream, std::string name, std::string file) {
    stream.name = std::move(name);
    stream.files = {{std::move(file), ""}};
    manifest.streams.push_back(std::move(stream));
  };
  add(flags.mocap_options, "mocap", flags.mocap);
  StreamOptions kinect;
  kinect.layout = flags.kinect_layout;
  if (!flags.kinect.empty()) {
    add(kinect, "kinect", flags.kinect);
    // The space is set only if there is a Kinect: a manifest must not move a stream that does not
    // exist.
    manifest.spaces["kinect"] = KA_TRY(space_of(flags));
  }
  for (const std::string& one : flags.points) {
    const auto [name, file] = KA_TRY(split_pair(one, "NAME=FILE").map_error(in_file("--points")));
    StreamOptions further;
    further.layout = flags.points_layout;
    add(further, name, file);
  }
  if (!flags.imu.empty()) manifest.streams.push_back(KA_TRY(nodes_of(flags)));
  KA_TRY(check_stream_names(manifest));
  return manifest;
}

Result<void> check_kinds(const QuickFlags& flags, const Recording& recording) {
  const std::vector<Wanted> wanted = wanted_kinds(flags);
  // Opening makes one stream for each file, so both lists have the same order and length.
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const RecordedStream& stream = recording.streams[i];
    const auto& kinds = wanted[i].kinds;
    if (std::find(kinds.begin(), kinds.end(), stream.data.index()) != kinds.end()) continue;
    return Failure(Error{wanted[i].path, 0, wanted[i].expected + " for " + wanted[i].flag,
                         contents_line(stream)});
  }
  return {};
}

}  // namespace kinalign
