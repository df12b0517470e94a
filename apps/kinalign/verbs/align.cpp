// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/field_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/summary.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/align_job.h"
#include "apps/kinalign/verbs/inputs.h"
#include "apps/kinalign/verbs/quick.h"

#include "kinalign/align/plan.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/formats/unknown_file.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/open_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace kinalign {

namespace {

/// The input of `align`, and the options that override those of a manifest.
struct AlignVerb {
  std::vector<std::string> manifest;  // at most one
  AlignOptions options;               // the options of alignment
  bool slerp = false;                 // the same as --rotations slerp
  QuickFlags quick;
};

/// Checks that the flags fit together. Either a manifest or the flags of single files must be
/// given, not both.
Result<void> check_use(const AlignVerb& o, const Common& common, const Sources& given) {
  const bool quick = !o.quick.mocap.empty();
  if (!o.manifest.empty()) KA_TRY(refuse_with_input(o.manifest.front(), given));
  if (o.manifest.empty() && !quick) {
    return Failure(Error{"", 0, "either a recording.toml or --mocap FILE", "neither"});
  }
  if (quick) {
    KA_TRY(refuse_alone(o.quick, given));
    // quick_manifest() is called only for its errors: a wrong NAME=FILE must be wrong use (exit
    // code 2), before any file is opened.
    KA_TRY(quick_manifest(o.quick));
  }
  const auto rotations = given.find("rotations");
  // --slerp contradicts --rotations only on the command line; it overrides a settings file.
  if (o.slerp && rotations != given.end() && rotations->second == Source::flag) {
    return Failure(Error{"--slerp", 0, "--rotations or --slerp", "both"});
  }
  if (common.out.empty() && !common.dry_run) {
    return Failure(Error{"-o", 0, "the take's file name, as in -o take.h5", "none"});
  }
  return {};
}

/// The command line of `kinalign align`.
Usage describe_verb_options(AlignVerb& o) {
  Usage usage;
  usage.positionals = {
      {"RECORDING",
       "a recording by `record`, or a recording.toml with streams, files and clocks",
       &o.manifest,
       0,
       1,
       {},
       "give single files by flags: --mocap a.bvh --kinect b.csv --imu waist=c.csv"}};
  usage.flags = o.quick.fields();
  usage.flags.push_back({"slerp", "the same as --rotations slerp", &o.slerp});
  usage.settings = describe(o.options);
  usage.check = [&o](const Common& common, const Sources& given) {
    return check_use(o, common, given);
  };
  return usage;
}

/// The manifest by which the recording is aligned. `recording` is set if a recording had to be
/// opened to make the manifest.
struct ToAlign {
  Manifest manifest;
  std::shared_ptr<RecordingSource> recording{};
};

/// The error for a file that is neither a recording nor a manifest. It states what the file is
/// instead.
Result<Error> no_recording(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  const std::string_view head = KA_TRY(file.next());
  if (head.empty()) return unknown_file(path, head);
  // A file named .mcap should be a recording, so any other content gets its own message.
  if (path.ends_with(".mcap")) {
    return Error{
        path, 0,
        "an MCAP file, as its name says (give a file of another kind after --mocap, --kinect, ...)",
        beginning_of(head)};
  }
  return Error{path, 0,
               "a recording or a recording.toml (give a single file after --mocap, --kinect, ...)",
               "another extension"};
}

/// Makes the manifest from a file or from the flags, with the options of this call.
Result<ToAlign> wanted_with_options(AlignVerb& o, const Call& call) {
  ToAlign wanted;
  Manifest& manifest = wanted.manifest;
  if (o.manifest.empty()) {
    manifest = KA_TRY(quick_manifest(o.quick));
    manifest.align = o.options;
    return wanted;
  }
  FileSystem& files = call.surroundings.files;
  const std::string& path = o.manifest.front();
  if (KA_TRY(kind_of_file(files, path)) == FileKind::recording) {
    // The recording stays open, so that open_files() need not open and read it a second time.
    wanted.recording = KA_TRY(RecordingSource::open(files, path, RecordingSource::Devices::learned,
                                                    {}, call.console.progress()));
    manifest = KA_TRY(recorded_manifest(wanted.recording->survey(), path));
    manifest.align = o.options;
    return wanted;
  }
  if (!path.ends_with(".toml")) return Failure(KA_TRY(no_recording(files, path)));
  manifest = KA_TRY(load_manifest(files, path, o.options));
  // A flag or an environment variable overrides the manifest. A settings file only sets options
  // that the manifest does not state.
  copy_given(describe(o.options), describe(manifest.align), call.sources, Source::environment);
  return wanted;
}

Result<ToAlign> wanted_of(AlignVerb& o, const Call& call) {
  ToAlign wanted = KA_TRY(wanted_with_options(o, call));
  if (o.slerp) wanted.manifest.align.rotations = "slerp";
  return wanted;
}

/// Checks --reference against the names of the manifest's streams. A reference from a settings file
/// is not checked, because it may be meant for other recordings.
Result<void> check_reference(const AlignVerb& o, const Manifest& manifest, const Sources& given) {
  const auto source = given.find("reference");
  if (source == given.end() || source->second != Source::flag) return {};
  std::vector<std::string> names;
  for (const StreamOptions& stream : manifest.streams) names.push_back(stream.name);
  const std::string& wanted = o.options.reference;
  if (std::find(names.begin(), names.end(), wanted) == names.end()) {
    return Failure(Error{"--reference", 0, "a stream: " + any_of(names), shown(wanted)});
  }
  // With flags for single files, the Kinect's coordinates are fitted to the mocap's by default. If
  // the Kinect is the reference, it must not be moved.
  const auto moved = manifest.spaces.find(wanted);
  if (o.manifest.empty() && moved != manifest.spaces.end() && moved->second.method != "none") {
    return Failure(Error{"--reference", 0,
                         "--space none as well, because the reference is not moved",
                         "--space " + moved->second.method});
  }
  return {};
}

/// Advice if a stream does not overlap the others in time: a start time with which it would begin
/// together with them. Only streams whose absolute time is set by hand can be moved: points, and
/// files with a fixed time between frames (BVH). `first` to `last` is the time that all other
/// streams share.
std::string start_advice(const AlignVerb& o, const Recording& recording, const Manifest& manifest) {
  for (const RecordedStream& s : recording.streams) {
    Time first = Time::min(), last = Time::max();
    for (const RecordedStream& other : recording.streams) {
      if (&other == &s) continue;
      first = std::max(first, first_of(other));
      last = std::min(last, last_of(other));
    }
    const Time own = first_of(s);
    const bool apart = own > last || last_of(s) < first;
    // Stamps out of range, and the initial values of `first` and `last`, would overflow in the sums
    // below.
    const auto near = [](Time t) {
      return to_ns(t) > -largest_stamp_ns && to_ns(t) < largest_stamp_ns;
    };
    const bool is_known = near(own) && near(first);
    const bool quick = o.manifest.empty();
    const bool placed = s.step_ns || std::holds_alternative<PointInput>(s.data);
    if (!placed || !apart || first > last || !is_known || (quick && s.name != "mocap")) continue;
    // The first frame comes later than start_ns by a constant latency. To keep this latency,
    // start_ns is moved by as much as the first frame.
    const std::int64_t start =
        s.step_ns ? options_of(manifest, s.name).start_ns.value_or(0) : to_ns(s.survey.first);
    const std::int64_t latency = to_ns(own) - start;
    const std::string where = quick ? "--start-ns {}" : "start_ns = {} in [stream." + s.name + "]";
    return fmt::format(fmt::runtime(where), to_ns(first) - latency) + " moves the first frame of " +
           shown(s.name) +
           " to the start of the others: correct only if all started at the same time";
  }
  return "";
}

/// The lines below an error. `path`: the manifest's path; empty if there is none. An error without
/// a file comes from the flags. An error with a line comes from an input, about which `kinalign
/// check` may know more.
std::vector<std::string> advice(const std::string& path, const Error& error) {
  std::vector<std::string> lines{"nothing was written"};
  const bool named = !path.empty() && error.file == path;
  const bool manifest = path.ends_with(".toml") && named;
  if (error.file.empty() || manifest) {
    lines.push_back(manifest ? "docs/formats/recording_toml.md shows the keys"
                             : "kinalign align --help shows the flags");
    if (!manifest && error.kind == ErrorKind::too_few_joints) {
      lines.push_back(
          "--joint KINECT=MOCAP states that two joints are the same, and may be repeated; kinalign "
          "info FILE -v lists the names of both");
    }
    if (const std::string names = name_advice(error); !names.empty()) lines.push_back(names);
  } else if (named && error.kind == ErrorKind::no_rows_in_recording) {
    lines.push_back("kinalign check " + path + " shows what is wrong with the recording");
  } else if (error.line > 0) {
    lines.push_back("kinalign check " + error.file + " lists other faults before that line");
  }
  return lines;
}

/// Opens all files. A recording that is already open is used again. Files that were given by flags
/// must have the right kind of content. The paths in the manifest are relative to the folder
/// `base`.
Result<Recording> open_files(const AlignVerb& o, const ToAlign& wanted, const std::string& base,
                             Call& call) {
  Recording recording =
      KA_TRY(open_recording(call.surroundings.files, wanted.manifest, base,
                            {call.console.progress(), call.jobs, wanted.recording}));
  for (const RecordedStream& stream : recording.streams) {
    call.console.detail(harmless(read_as(stream)));
  }
  if (o.manifest.empty()) KA_TRY(check_kinds(o.quick, recording));
  return recording;
}

/// Aligns a recording and writes the take. No input is ever overwritten, nor any part of a
/// recording in several files.
Result<int> run(AlignVerb& o, Call& call) {
  const std::string path = o.manifest.empty() ? "" : o.manifest.front();
  call.console.if_it_fails([path](const Error& error) { return advice(path, error); });
  ToAlign wanted = KA_TRY(wanted_of(o, call));
  Manifest& manifest = wanted.manifest;
  // Paths in flags are relative to the current folder, paths in a manifest to the manifest's
  // folder.
  const std::string base =
      o.manifest.empty() ? cut_common_folder(manifest) : std::string(folder(o.manifest.front()));
  // --dry-run aligns the whole recording and prints the same report, but writes no file.
  const std::string out = call.common.dry_run ? "" : call.common.out;
  KA_TRY(keep_inputs(out, o.manifest));
  KA_TRY(keep_inputs(out, with_siblings(call.surroundings.files, files_named(manifest, base))));
  // A stream's name can be checked only after the manifest was read. A wrong name is still wrong
  // use (exit code 2).
  for (const auto& use : {check_take_name(out), check_reference(o, manifest, call.sources)}) {
    if (!use) return call.console.refuse(use.error());
  }
  // The advice about start times needs the open streams, so it is set after they were opened.
  const Recording recording = KA_TRY(open_files(o, wanted, base, call));
  call.console.if_it_fails(
      [path, start = start_advice(o, recording, manifest)](const Error& error) {
        std::vector<std::string> lines = advice(path, error);
        const bool apart = error.kind == ErrorKind::no_common_span;
        if (apart && !start.empty()) lines.push_back(start);
        return lines;
      });
  // Errors of the plan name no file. The user can correct them in the manifest, so its path is
  // added.
  const AlignmentReport report =
      KA_TRY(align_to_file(call, recording, manifest, {out, call.common.overwrite()})
                 .map_error(in_file(path)));
  call.console.wrote(out);
  call.console.print(summary(report, out, call.console));
  call.console.print_json("{\"report\": " + report_json(report) + "}");
  return code_of(report.findings);
}

}  // namespace

/// The verb `kinalign align`.
Verb align_verb() {
  return make_verb<AlignVerb>(
      {.name = "align",
       .summary = "bring raw files of one motion into a take: one grid, one space",
       .text =
           "Cuts all streams to their common span and resamples them onto the reference's stamps; "
           "no values are made up across a gap. The take is an HDF5 file that h5py and MATLAB "
           "open; it contains the report and every parameter. Exit code 1 if there were warnings.",
       .examples =
           {{"kinalign align takes/03_S1A02_01.mcap -o take.h5",
             "a recording, even if it is truncated"},
            {"kinalign align demo/recording.toml -o demo/mine.h5", "the files of a manifest"},
            {"kinalign align --mocap demo/mocap.bvh --start-ns 1790000000000000000 --kinect "
             "demo/kinect.csv -o demo/quick.h5",
             "two files without a manifest; a BVH contains no time of day"},
            {"kinalign align --mocap demo/mocap.bvh --start-ns 1790000000000000000 --imu "
             "waist=demo/imu_waist.csv --imu wrist_left=demo/imu_wrist_left.csv --root-node waist "
             "-o demo/nodes.h5",
             "nodes, moved into the waist's space"}},
       .common = {"out", "force", "json", "dry_run", "jobs"}},
      describe_verb_options, run);
}

}  // namespace kinalign
