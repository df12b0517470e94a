// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/align_job.h"
#include "apps/kinalign/console.h"
#include "apps/kinalign/inputs.h"
#include "apps/kinalign/quick.h"
#include "apps/kinalign/summary.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/io/open_recording.h"
#include "kinalign/io/report_json.h"

#include <string>
#include <vector>

namespace kinalign {

namespace {

/// What to align, and what overrides a manifest.
struct AlignVerb {
  std::vector<std::string> manifest;  // at most one
  AlignOptions options;
  QuickFlags quick;
};

Result<void> check_use(const AlignVerb& o, const Common& common, const Sources& given) {
  const bool quick = !o.quick.mocap.empty();
  if (!o.manifest.empty()) KA_TRY(refuse_beside(o.manifest.front(), given));
  if (o.manifest.empty() && !quick) {
    return Failure(Error{"", 0, "either a recording.toml or --mocap FILE", "neither"});
  }
  if (quick) {
    KA_TRY(refuse_alone(o.quick, given));
    KA_TRY(quick_manifest(o.quick));
  }
  if (common.out.empty() && !common.dry_run) {
    return Failure(Error{"-o", 0, "the take's file name, as in -o take.h5", "none"});
  }
  return {};
}

Usage describe_verb_options(AlignVerb& o) {
  Usage usage;
  usage.positionals = {{"RECORDING", "recording.toml: streams, files, clocks", &o.manifest, 0, 1}};
  usage.flags = o.quick.fields();
  usage.settings = describe(o.options);
  usage.check = [&o](const Common& common, const Sources& given) {
    return check_use(o, common, given);
  };
  return usage;
}

Result<Manifest> manifest_of(AlignVerb& o, const Call& call) {
  if (o.manifest.empty()) {
    Manifest manifest = KA_TRY(quick_manifest(o.quick));
    manifest.align = o.options;
    return manifest;
  }
  const std::string& path = o.manifest.front();
  KA_TRY(
      InputFile::open(call.surroundings.files, path));  // what it is comes before what it is named
  if (!path.ends_with(".toml")) {
    return Failure(Error{path, 0,
                         "a recording.toml (a single file goes behind --mocap, --kinect, ...)",
                         "another ending"});
  }
  Manifest manifest = KA_TRY(load_manifest(call.surroundings.files, path, o.options));
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
  if (o.manifest.empty()) KA_TRY(check_kinds(o.quick, recording));
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
