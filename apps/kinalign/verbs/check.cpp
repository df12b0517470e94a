// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/check.h"

#include "apps/cli/console.h"
#include "apps/cli/program.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/describe_report.h"
#include "apps/kinalign/text/describe_xdf.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/align/arrivals_of.h"
#include "kinalign/align/judge.h"
#include "kinalign/align/plan.h"
#include "kinalign/align/space.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"

#include <fmt/format.h>

#include <filesystem>

namespace kinalign {

namespace {

/// The options of `kinalign check`. Flags of a stream apply to every file in `files`.
struct Check {
  std::vector<std::string> files;
  StreamFlags stream;
};

/// The command line of `kinalign check`.
Usage describe_check(Check& o) {
  Usage usage;
  usage.positionals = {{"FILE",
                        "takes, recordings, recording.toml, XDF, streams' files or a BIDS folder",
                        &o.files, 1, SIZE_MAX}};
  usage.flags = o.stream.fields();
  usage.check = [&o](const Common&, const Sources&) -> Result<void> {
    // The call is for its error: a wrong --select is wrong use.
    KA_TRY(o.stream.stream({}));
    return {};
  };
  return usage;
}

/// Reads every row of a take and returns its report. Runs in the child process.
/// The rows themselves are not judged again: the report in the take holds the findings of
/// alignment.
Result<std::string> read_through(FileSystem& files, const std::string& path) {
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  TakeSlab slab;
  std::uint64_t rows = 0;
  while (KA_TRY(reader.next(slab))) rows += slab.stamps.size();
  // The rows that were read must be as many as the header says.
  if (rows != reader.header().frames) {
    return Failure(
        Error{path, 0, fmt::format("{} rows", reader.header().frames), std::to_string(rows)});
  }
  return reader.report_json();
}

/// Problems that alignment would report before it reads a sample: joints, nodes, the common span.
/// Runs the first part of alignment, which needs no samples. An error there is one finding, since
/// the other files are to be checked too.
Findings check_plan(const std::string& path, const Input& input) {
  const auto judged = [&input]() -> Result<Findings> {
    const AlignPlan plan = KA_TRY(plan_alignment(input.recording, *input.manifest));
    KA_TRY(plan_spaces(plan.header, *input.manifest, plan.streams[plan.reference].group));
    return judge_plan(input.recording, plan);
  }();
  if (judged) return *judged;
  Error error = judged.error();
  // The plan's errors are about the manifest unless they name a stream's file.
  if (error.file.empty()) error.file = path;
  const std::string repair = name_advice(error);
  return {
      {Severity::error, std::move(error), "kinalign align can't make a take of this file", repair}};
}

/// Refuses the call (exit code 2) if a flag does not apply to the file.
Result<void> check_flags(const Check& o, const std::string& path, const RecordedStream* stream,
                         Call& call) {
  auto used = o.stream.check_use(path, stream, call.sources);
  return used ? Result<void>{} : call.console.refuse(std::move(used).error());
}

/// The findings, and the number of files they are about.
struct Checked {
  Findings findings;
  std::size_t files = 1;
};

Result<Checked> check_take(const Check& o, const std::string& path, Call& call) {
  FileSystem& files = call.surroundings.files;
  KA_TRY(check_flags(o, path, nullptr, call));
  // A damaged take can crash HDF5, so it is read in a child process that returns the report's JSON.
  const std::string report =
      KA_TRY(run_guarded(GuardLimits{}, blame(path), [&] { return read_through(files, path); }));
  Checked out{KA_TRY(report_findings(report, path))};
  for (Finding& finding : out.findings) {  // several takes may be checked, so the take is named too
    std::string& file = finding.what.file;
    file = file.empty() ? path : fmt::format("{}: {}", path, file);
  }
  return out;
}

/// Replaces a file's name in the findings by the path that the user typed. A take names inputs
/// relative to the manifest.
/// Readers name a file by its last part. Without a manifest, the user must find the word that was
/// typed.
void name_as_typed(const std::string& path, const RecordedStream& stream, Findings& findings) {
  for (Finding& finding : findings) {
    if (finding.what.file == stream.files.front().name) finding.what.file = path;
  }
}

/// Checks a recording with all of its parts.
Result<Checked> check_recording(const Check& o, const std::string& path, Call& call) {
  KA_TRY(check_flags(o, path, nullptr, call));
  FileSystem& files = call.surroundings.files;
  // Checking reads no streams of a recording, so the clocks are not fitted.
  const auto recording = KA_TRY(RecordingSource::open(
      files, path, RecordingSource::Devices::surveyed, {}, call.console.progress()));
  Checked out{judge_survey(path, recording->survey())};
  append(out.findings, judge_parts(files, recording->parts(), Severity::warning));
  return out;
}

Result<Checked> check_xdf(const Check& o, const std::string& path, Call& call) {
  KA_TRY(check_flags(o, path, nullptr, call));
  return Checked{
      judge_xdf(path, KA_TRY(survey_xdf(call.surroundings.files, path, call.console.progress())))};
}

/// A note about a stream's file whose ending is that of another format.
/// The content decides how a file is read. The wrong extension would mislead the next user or
/// another program.
Findings judge_name(const std::string& path, const RecordedStream& stream) {
  const bool misnamed = path.ends_with(".mcap") || path.ends_with(".xdf") || path.ends_with(".h5");
  if (!misnamed) return {};
  return {{Severity::note,
           Error{path, 0, "the kind of file that its extension says",
                 stream.format + ": " + contents_line(stream)},
           "the file was checked as what it contains",
           "rename the file to the extension of its kind"}};
}

/// Reads all streams in parallel. The findings are about stamps, arrivals and values.
Result<Findings> check_streams(const Check& o, const Input& input, Call& call) {
  const Recording& recording = input.recording;
  // The reference keeps its stamps and the others are resampled, so their steps are judged
  // differently.
  const std::string reference = input.manifest ? reference_name(recording, *input.manifest) : "";
  const auto options = [&](const RecordedStream& stream) -> const StreamOptions& {
    return input.manifest ? options_of(*input.manifest, stream.name) : o.stream.options;
  };
  const auto role = [&](const RecordedStream& stream) {
    return input.manifest && stream.name == reference ? Role::reference : Role::resampled;
  };
  for (const RecordedStream& stream : recording.streams) {
    call.console.detail(harmless(read_as(stream)));
  }
  // arrivals_of() reads each stream once, in parallel. The loop below only judges what it found.
  const std::vector<Arrivals> arrivals = KA_TRY(arrivals_of(
      recording.streams,
      [&](const RecordedStream& s) { return taken_step(s, options(s), role(s)); },
      call.console.progress()));
  Findings out;
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    const RecordedStream& stream = recording.streams[i];
    // Findings of a file that several streams share are listed at its first stream only.
    if (const SharedFile* file = newly_read_file(recording, i)) append(out, file->findings);
    Findings found = all_findings(stream);
    append(found, judge_stamps(stream, options(stream)));
    append(found, judge_arrivals(stream, arrivals[i], role(stream)));
    append(found, judge_start(stream, options(stream), arrivals[i]));
    append(out, with_stream_name(stream, recording, std::move(found)));
  }
  return out;
}

/// Checks a stream's file, or a manifest with all of its streams.
Result<Checked> check_input(const Check& o, const std::string& path, Call& call) {
  FileSystem& files = call.surroundings.files;
  // A manifest takes no flags of a stream. This is known before the file is read, and a manifest
  // can be long to read.
  if (path.ends_with(".toml")) KA_TRY(check_flags(o, path, nullptr, call));
  const Input input = KA_TRY(open_input(files, path, o.stream, call.console.progress()));
  if (!input.manifest) KA_TRY(check_flags(o, path, &input.recording.streams.front(), call));
  Checked out;
  // The summary counts the files behind a manifest, and not the manifest itself.
  if (input.manifest) out.files = files_named(*input.manifest, "").size();
  append(out.findings, KA_TRY(check_streams(o, input, call)));
  if (input.manifest) {
    // The findings about streams come first, since one of them may be the cause of a plan that
    // fails.
    append(out.findings, check_plan(path, input));
  } else {
    append(out.findings, judge_name(path, input.recording.streams.front()));
    name_as_typed(path, input.recording.streams.front(), out.findings);
  }
  return out;
}

/// Checks a folder of BIDS. A kinalign data set is checked by `kinalign dataset verify`.
Result<Checked> check_folder(const Check& o, const std::string& path, Call& call) {
  namespace fs = std::filesystem;
  KA_TRY(check_flags(o, path, nullptr, call));
  // Both kinds of folder may hold takes, but only `dataset verify` knows the catalogue.
  if (fs::exists(path + "/dataset.toml")) {
    return Failure(Error{path, 0, "kinalign dataset verify for a data set", "kinalign check"});
  }
  const BidsListing listing = KA_TRY(list_bids_folder(call.surroundings.files, path));
  if (!listing.has("dataset_description.json")) {
    return Failure(Error{path, 0, "a file, or a BIDS data set with dataset_description.json",
                         "a directory", ErrorKind::directory});
  }
  Checked out{check_bids(listing), listing.paths.size()};
  // The listing has paths relative to the folder. A finding must name a path that the user can
  // open.
  for (Finding& finding : out.findings) finding.what.file = path + "/" + finding.what.file;
  return out;
}

Result<Checked> check_file(const Check& o, const std::string& path, Call& call) {
  // A directory can't be opened as a file, so it is recognised before the kind of a file is read.
  if (std::filesystem::is_directory(path)) return check_folder(o, path, call);
  switch (KA_TRY(kind_of_file(call.surroundings.files, path))) {
    case FileKind::recording:
      return check_recording(o, path, call);
    case FileKind::xdf:
      return check_xdf(o, path, call);
    case FileKind::take:
      return check_take(o, path, call);
    case FileKind::manifest:
    case FileKind::stream:
    case FileKind::model:    // contains no motion: opening it fails with that message
    case FileKind::unknown:  // opening it fails with the reason, unless --layout states its format
      break;
  }
  return check_input(o, path, call);
}

/// Checks all files and prints one list of findings. The worst case decides the exit code: 3 if a
/// file can't be used.
Result<int> run(Check& o, Call& call) {
  Findings all;
  std::size_t files = 0;
  bool usable = true;
  for (const std::string& path : o.files) {
    auto found = check_file(o, path, call);
    if (found) {
      append(all, found->findings);
      files += found->files;
      // A single file that can't be read is an error of the verb. Wrong use and Ctrl-C end the
      // whole run.
    } else if (o.files.size() == 1 || call.console.refused() || interrupted()) {
      return Failure(std::move(found).error());
    } else {  // an unreadable file must not hide problems of the others
      usable = false;
      all.push_back({Severity::error, std::move(found).error(), "the file can't be used", ""});
    }
  }
  call.console.print(finding_lines(all, call.console));
  if (all.empty()) {
    call.console.print(
        fmt::format("{} file{} read, nothing found\n", files, files == 1 ? "" : "s"));
  }
  call.console.print_json("{\"findings\": " + findings_json(all) + "}");
  return usable ? code_of(all) : failed;
}

}  // namespace

/// The verb `kinalign check`.
Verb check_verb() {
  return make_verb<Check>(
      {.name = "check",
       .summary = "find faults in files, with their meaning and repair",
       .text = "Reads every value. Checks whether a manifest can be aligned, and shows the "
               "findings in the report of a take. Exit code 1 if there are warnings or errors, 3 "
               "if a file can't be used.",
       .examples = {{"kinalign check demo/mocap.bvh", "frames, unit, stamps"},
                    {"kinalign check demo/*.csv --json", "many files, for programs"},
                    {"kinalign check walks_bids", "a whole BIDS-Motion data set"}},
       .common = {"json"}},
      describe_check, run);
}

}  // namespace kinalign
