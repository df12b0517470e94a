// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/check.h"

#include "apps/cli/console.h"
#include "apps/cli/program.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/describe_report.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/align/arrivals_of.h"
#include "kinalign/align/judge.h"
#include "kinalign/align/plan.h"
#include "kinalign/align/space.h"
#include "kinalign/check/judge_survey.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"

#include <fmt/format.h>

#include <filesystem>

namespace kinalign {

namespace {

/// The options of `kinalign check`. Flags that describe a stream apply to every file in `files`.
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
  // A wrong --select is wrong use, which is found here before a file is opened.
  usage.check = [&o](const Common&, const Sources&) {
    return o.stream.stream({}).map([](const StreamOptions&) {});
  };
  return usage;
}

/// Reads every row of a take and returns the take's report. Runs in a child process. The rows are
/// not checked again, because the report has the findings of the alignment.
Result<std::string> read_through(FileSystem& files, const std::string& path) {
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  TakeSlab slab;
  std::uint64_t rows = 0;
  while (KA_TRY(reader.next(slab))) rows += slab.stamps.size();
  // The take must have as many rows as its header states.
  if (rows != reader.header().frames) {
    return Failure(
        Error{path, 0, fmt::format("{} rows", reader.header().frames), std::to_string(rows)});
  }
  return reader.report_json();
}

/// The findings of the first part of alignment, which reads no samples: joints, nodes, the time
/// that all streams share. An error there becomes a finding, so that the other files are checked,
/// too.
Findings check_plan(const std::string& path, const Input& input) {
  const auto judged = [&input]() -> Result<Findings> {
    const AlignPlan plan = KA_TRY(plan_alignment(input.recording, *input.manifest));
    KA_TRY(plan_spaces(plan.header, *input.manifest, plan.streams[plan.reference].group));
    return judge_plan(input.recording, plan);
  }();
  if (judged) return *judged;
  Error error = judged.error();
  // An error that names no stream's file is about the manifest.
  if (error.file.empty()) error.file = path;
  const std::string repair = name_advice(error);
  return {
      {Severity::error, std::move(error), "kinalign align can't make a take of this file", repair}};
}

/// The findings, and the number of files that were checked.
struct Checked {
  Findings findings;
  std::size_t files = 1;
};

Result<Checked> check_take(FileSystem& files, const std::string& path) {
  // A damaged take can crash HDF5, so a child process reads it and returns the report as JSON.
  const std::string report =
      KA_TRY(run_guarded(GuardLimits{}, blame(path), [&] { return read_through(files, path); }));
  Checked out{KA_TRY(report_findings(report, path))};
  for (Finding& finding : out.findings) {  // with several takes the user must see which take it is
    std::string& file = finding.what.file;
    file = file.empty() ? path : fmt::format("{}: {}", path, file);
  }
  return out;
}

/// Puts the path that the user typed into the findings of a file. The readers name a file by the
/// last part of its path only.
void name_as_typed(const std::string& path, const RecordedStream& stream, Findings& findings) {
  for (Finding& finding : findings) {
    if (finding.what.file == stream.files.front().name) finding.what.file = path;
  }
}

/// Checks a recording with all of its parts.
Result<Checked> check_recording(FileSystem& files, const std::string& path,
                                const Progress& progress) {
  // Checking does not use the clocks of the devices, so they are not computed.
  const auto recording =
      KA_TRY(RecordingSource::open(files, path, RecordingSource::Devices::surveyed, {}, progress));
  Checked out{judge_survey(path, recording->survey())};
  append(out.findings, judge_parts(files, recording->parts(), Severity::warning));
  return out;
}

/// A note if a stream's file has the extension of another format. kinalign reads the file by its
/// content, but the extension would mislead people and other programs.
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
  // The reference stream keeps its stamps and the other streams are resampled, so the times between
  // samples are judged differently.
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
  // arrivals_of() reads all streams once, in parallel. The loop below judges the results.
  const std::vector<Arrivals> arrivals = KA_TRY(arrivals_of(
      recording.streams,
      [&](const RecordedStream& s) { return taken_step(s, options(s), role(s)); },
      call.console.progress()));
  Findings out;
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    const RecordedStream& stream = recording.streams[i];
    // If several streams come from one file, the file's findings are listed with the first of them.
    if (const SharedFile* file = newly_read_file(recording, i)) append(out, file->findings);
    Findings found = all_findings(stream);
    append(found, judge_stamps(stream, options(stream)));
    append(found, judge_arrivals(stream, arrivals[i], role(stream)));
    append(found, judge_start(stream, options(stream), arrivals[i]));
    append(out, with_stream_name(stream, recording, std::move(found)));
  }
  return out;
}

/// Checks the file of one stream, or a manifest with all of its streams.
Result<Checked> check_input(const Check& o, const std::string& path, Call& call) {
  FileSystem& files = call.surroundings.files;
  const Input input = KA_TRY(open_input(files, path, o.stream, call.console.progress()));
  if (!input.manifest) {
    KA_TRY(o.stream.check_use(path, &input.recording.streams.front(), call));
  }
  Checked out;
  // The summary counts the files that the manifest names, not the manifest itself.
  if (input.manifest) out.files = files_named(*input.manifest, "").size();
  append(out.findings, KA_TRY(check_streams(o, input, call)));
  if (input.manifest) {
    // The findings about streams come first, since they may explain an error of the plan.
    append(out.findings, check_plan(path, input));
  } else {
    append(out.findings, judge_name(path, input.recording.streams.front()));
    name_as_typed(path, input.recording.streams.front(), out.findings);
  }
  return out;
}

/// Checks a folder in the format BIDS. `kinalign dataset verify` checks a data set of kinalign.
Result<Checked> check_folder(const Check& o, const std::string& path, Call& call) {
  namespace fs = std::filesystem;
  KA_TRY(o.stream.check_use(path, nullptr, call));
  // A data set may look like a BIDS folder, but only `dataset verify` knows its dataset.toml.
  if (fs::exists(path + "/dataset.toml")) {
    return Failure(Error{path, 0, "kinalign dataset verify for a data set", "kinalign check"});
  }
  const BidsListing listing = KA_TRY(list_bids_folder(call.surroundings.files, path));
  if (!listing.has("dataset_description.json")) {
    return Failure(Error{path, 0, "a file, or a BIDS data set with dataset_description.json",
                         "a directory", ErrorKind::directory});
  }
  Checked out{check_bids(listing), listing.paths.size()};
  // The findings name files relative to the folder. The user needs a path that can be opened.
  for (Finding& finding : out.findings) finding.what.file = path + "/" + finding.what.file;
  return out;
}

Result<Checked> check_file(const Check& o, const std::string& path, Call& call) {
  // A folder can't be opened as a file, so it is recognised first.
  if (std::filesystem::is_directory(path)) return check_folder(o, path, call);
  FileSystem& files = call.surroundings.files;
  const FileKind kind = KA_TRY(kind_of_file(files, path));
  // Other kinds of file state how their streams are read, so flags that describe a stream are
  // refused before a long file is read. A model contains no motion; open_input() fails with that
  // message.
  if (kind != FileKind::stream && kind != FileKind::unknown && kind != FileKind::model) {
    KA_TRY(o.stream.check_use(path, nullptr, call));
  }
  const Progress progress = call.console.progress();
  if (kind == FileKind::recording) return check_recording(files, path, progress);
  if (kind == FileKind::take) return check_take(files, path);
  if (kind == FileKind::xdf) {
    return Checked{judge_survey(path, KA_TRY(survey_xdf(files, path, progress)))};
  }
  // For a file of unknown format, opening fails with the reason, unless --layout states the format.
  return check_input(o, path, call);
}

/// Checks all files and prints one list of findings. The worst result decides the exit code; 3
/// means that a file can't be used.
Result<int> run(Check& o, Call& call) {
  Findings all;
  std::size_t files = 0;
  bool usable = true;
  for (const std::string& path : o.files) {
    auto found = check_file(o, path, call);
    if (found) {
      append(all, found->findings);
      files += found->files;
      // If there is only one file, its error is the verb's error. Wrong use and Ctrl-C end the verb
      // in any case.
    } else if (o.files.size() == 1 || call.console.refused() || interrupted()) {
      return Failure(std::move(found).error());
    } else {  // the other files must still be checked
      usable = false;
      all.push_back({Severity::error, std::move(found).error(), "the file can't be used", ""});
    }
  }
  call.console.print(finding_lines(all, call.console));
  if (all.empty()) {
    call.console.print(counted(files, "file") + " read, nothing found\n");
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
