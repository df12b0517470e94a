// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/align_job.h"
#include "apps/kinalign/console.h"
#include "apps/kinalign/inputs.h"
#include "apps/kinalign/summary.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/io/manifest_toml.h"
#include "kinalign/io/open_recording.h"
#include "kinalign/io/report_json.h"

#include <string>
#include <vector>

namespace kinalign {

namespace {

/// The quick case without a manifest, and what overrides one.
struct AlignVerb {
  std::vector<std::string> manifest;  // at most one
  AlignOptions options;

  std::string mocap, kinect;
  std::vector<std::string> points;  // NAME=FILE
  std::vector<std::string> imu;     // NODE=FILE
  std::string kinect_layout, imu_layout, root_node;
  StreamOptions mocap_options;
  SpaceOptions space;
  std::vector<std::string> joints;  // JOINT=JOINT
};

Fields flags(AlignVerb& o) {
  return {
      {"mocap", "the reference: a BVH, or a file of points", &o.mocap},
      {"kinect", "a file of Kinect joints", &o.kinect},
      {"imu", "a node's file; may be repeated", &o.imu},
      {"points", "a further file of points; may be repeated", &o.points},
      {"kinect_layout", "layout of the Kinect file", &o.kinect_layout},
      {"imu_layout", "layout of the nodes' files", &o.imu_layout},
      {"root_node", "node into whose space all nodes are brought", &o.root_node},
      {"start_ns", "stamp of the click that started the mocap, ns since 1970",
       &o.mocap_options.start_ns, -4e18, 4e18},
      {"metres_per_unit", "length of the mocap file's unit, m; 0: the format's own (BVH: 0.01)",
       &o.mocap_options.metres_per_unit, 0.0, 1000.0},
      {"up",
       "the mocap file's up axis (BVH: y)",
       &o.mocap_options.up,
       -1e308,
       1e308,
       {"", "y", "z"}},
      {"space",
       "how the Kinect comes into the mocap's space",
       &o.space.method,
       -1e308,
       1e308,
       {"none", "paper", "fit"}},
      {"rotation_y_deg", "of --space paper: turn about the y axis, degrees",
       &o.space.rotation_y_deg, -360.0, 360.0},
      {"joint", "of --space: a Kinect's and a mocap's joint that mean one place; may be repeated",
       &o.joints}};
}

Usage describe_verb_options(AlignVerb& o) {
  o.space.method = "fit";
  Usage usage;
  usage.positionals = {{"RECORDING", "recording.toml: streams, files, clocks", &o.manifest, 0, 1}};
  usage.flags = flags(o);
  usage.settings = describe(o.options);
  usage.check = [&o](const Common& common) -> Result<void> {
    const bool quick = !o.mocap.empty();
    if (o.manifest.empty() != quick) {
      return Failure(
          Error{"", 0, "either a recording.toml or --mocap FILE", quick ? "both" : "neither"});
    }
    if (common.out.empty() && !common.dry_run) {
      return Failure(Error{"-o", 0, "the take's file name, as in -o take.h5", "none"});
    }
    return {};
  };
  return usage;
}

Result<Manifest> quick_manifest(const AlignVerb& o) {
  Manifest manifest;
  const auto add = [&manifest](StreamOptions stream, std::string name, std::string file) {
    stream.name = std::move(name);
    stream.files = {{std::move(file), ""}};
    manifest.streams.push_back(std::move(stream));
  };
  SpaceOptions space = o.space;
  for (const std::string& joint : o.joints) {
    space.joints.insert(KA_TRY(split_pair(joint, "--joint KINECT=MOCAP")));
  }
  add(o.mocap_options, "mocap", o.mocap);
  StreamOptions kinect;
  kinect.layout = o.kinect_layout;
  if (!o.kinect.empty()) {
    add(kinect, "kinect", o.kinect);
    manifest.spaces["kinect"] = space;
  }
  for (const std::string& one : o.points) {
    const auto [name, file] = KA_TRY(split_pair(one, "--points NAME=FILE"));
    add({}, name, file);
  }
  StreamOptions nodes;
  nodes.name = "imu";
  nodes.layout = o.imu_layout;
  nodes.root_node = o.root_node;
  for (const std::string& one : o.imu) {
    const auto [node, file] = KA_TRY(split_pair(one, "--imu NODE=FILE"));
    nodes.files.push_back({file, node});
  }
  if (!nodes.files.empty()) manifest.streams.push_back(nodes);
  return manifest;
}

Result<Manifest> manifest_of(AlignVerb& o, const Call& call) {
  if (o.manifest.empty()) {
    Manifest manifest = KA_TRY(quick_manifest(o));
    manifest.align = o.options;
    return manifest;
  }
  constexpr std::size_t longest = std::size_t{1} << 20;
  const std::string& path = o.manifest.front();
  KA_TRY(
      InputFile::open(call.surroundings.files, path));  // what it is comes before what it is named
  if (!path.ends_with(".toml")) {
    return Failure(Error{path, 0,
                         "a recording.toml (a single file goes behind --mocap, --kinect, ...)",
                         "another ending"});
  }
  const std::string text = KA_TRY(read_whole(call.surroundings.files, path, longest));
  Manifest manifest = KA_TRY(read_manifest(text, path));
  copy_given(describe(o.options), describe(manifest.align), call.sources, Source::environment);
  return manifest;
}

std::vector<std::string> advice(const Error& error) {
  std::vector<std::string> lines{"nothing was written"};
  if (error.file.empty()) {
    lines.push_back(
        "kinalign align --help shows the flags, docs/formats/recording_toml.md the keys");
  } else if (error.line > 0 && !error.file.ends_with(".toml")) {
    lines.push_back("kinalign check " + error.file + " lists all that is wrong with it");
  }
  return lines;
}

Result<int> run(AlignVerb& o, Call& call) {
  call.console.if_it_fails(advice);
  const Manifest manifest = KA_TRY(manifest_of(o, call));
  const std::string base = o.manifest.empty() ? "" : std::string(folder(o.manifest.front()));
  const Progress progress = call.console.progress();
  const std::string out = call.common.dry_run ? "" : call.common.out;
  KA_TRY(keep_inputs(out, o.manifest));
  KA_TRY(keep_inputs(out, files_named(manifest, base)));
  const Recording recording =
      KA_TRY(open_recording(call.surroundings.files, manifest, base, progress, call.jobs));
  const AlignmentReport report =
      KA_TRY(align_to_file(call, recording, manifest, {out, call.common.overwrite()}));
  call.console.print(summary(report, out, call.console));
  call.console.print_json(report_json(report));
  return 0;
}

}  // namespace

Verb align_verb() {
  return make_verb<AlignVerb>(
      {.name = "align",
       .summary = "raw files of one motion into a take: one grid, one space",
       .text = "Streams are cut to the span they share and resampled onto the reference's stamps; "
               "nothing is invented across a gap. The take is an HDF5 file that h5py and MATLAB "
               "open, with the report and every parameter inside.",
       .examples =
           {{"kinalign align demo/recording.toml -o demo/take.h5", "what the manifest says"},

            {"kinalign align --mocap walk.bvh --start-ns 1790000000000000000 --kinect kinect.csv "
             "-o take.h5",
             "two files without a manifest; a BVH knows no time of day"},
            {"kinalign align --mocap walk.bvh --imu waist=w.csv --imu wrist_left=l.csv "
             "--root-node waist -o take.h5",
             "nodes, brought into the waist's space"}},
       .common = {"out", "force", "json", "dry_run", "jobs"}},
      describe_verb_options, run);
}

}  // namespace kinalign
