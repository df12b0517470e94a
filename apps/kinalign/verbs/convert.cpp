// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/describe_report.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/align/judge.h"
#include "kinalign/align/own_rows.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/take/take_bvh.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/formats/take/take_npz.h"
#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/open_recording.h"
#include "kinalign/view/show_recording.h"
#include "kinalign/view/show_xdf.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// The options of `kinalign convert`. The parser guarantees one word in each of both lists.
struct Convert {
  std::vector<std::string> from, to;  // one of each
  bool store_double = false;          // 8-byte numbers in an NPZ
  StreamFlags stream;
};

/// The command line of `kinalign convert`. The ending of the new file decides its format.
Usage describe_convert(Convert& o) {
  Usage usage;
  usage.positionals = {
      {"IN", "a take, a recording, or a stream's file", &o.from},
      {"OUT", "a new file; its extension .npz, .bvh or .mcap decides the format", &o.to}};
  usage.flags = o.stream.fields();
  usage.flags.push_back({"double", "store 8-byte numbers instead of 4-byte ones", &o.store_double});
  usage.check = [&o](const Common&, const Sources&) -> Result<void> {
    // The extension alone decides the format, so an unknown one must not be guessed.
    const std::string& to = o.to.front();
    if (!to.ends_with(".npz") && !to.ends_with(".bvh") && !to.ends_with(".mcap")) {
      return Failure(Error{to, 0, "a name that ends in .npz, .bvh or .mcap", "another extension"});
    }
    if (o.store_double && !to.ends_with(".npz")) {
      return Failure(Error{"--double", 0, "a new file that ends in .npz", shown(to)});
    }
    KA_TRY(o.stream.stream({}));
    return {};
  };
  return usage;
}

/// One conversion: from one file to one new file. `files` is the call's and must outlive the job.
struct Job {
  FileSystem& files;
  std::string from, to;
  Overwrite overwrite;
  bool store_double = false;
};

/// The rows of a stream in the form that a take stores.
/// The overloads below give the three kinds of streams one shape, so write_rows() and
/// stream_to_npz() are written once.
ClipRows rows_of(const ClipInput& input, ClipFrames& block) {
  return own_rows(input.skeleton, std::move(block));
}

PointRows rows_of(const PointInput&, PointFrames& block) { return own_rows(std::move(block)); }

// The last member, the distance of samples from raw ones, stays empty: rows as recorded were not
// resampled.
ImuRows rows_of(const ImuInput&, ImuSamples& block) {
  return {std::move(block.orientation),
          std::move(block.acceleration),
          std::move(block.angular_velocity),
          std::move(block.valid),
          {}};
}

ClipGroup group_of(const ClipInput& input) { return {input.skeleton}; }
PointGroup group_of(const PointInput& input) { return {input.joint_names}; }
ImuGroup group_of(const ImuInput& input) { return {input.node_names, input.content, ""}; }

/// Writes all rows of a stream to an NPZ, block by block.
/// The lengths of an NPZ's arrays are fixed before the first row. `frames` is the survey's count
/// and the end of the progress.
template <class Input, class Frames>
Result<void> write_rows(const Input& input, const Passes<Frames>& passes, std::uint64_t frames,
                        const Progress& progress, TakeNpzWriter& writer) {
  const Pass<Frames> pass = KA_TRY(passes());
  Frames block;
  TakeSlab slab;
  while (KA_TRY(pass(block))) {
    slab.stamps = block.stamps;
    slab.rows = {rows_of(input, block)};
    KA_TRY(writer.append(slab));
    // `first` is the number of the slab's first row in the whole file.
    slab.first += slab.stamps.size();
    if (!go_on(progress, "converting", slab.first, frames)) return Failure(interruption());
  }
  return writer.finish();
}

/// Writes one stream's file as an NPZ. The stream's own names are kept without a prefix.
Result<void> stream_to_npz(const Job& job, const RecordedStream& stream, const Progress& progress) {
  TakeHeader header;
  // The survey counted all rows when the file was opened, so the arrays' lengths are known in
  // advance.
  header.frames = stream.survey.samples;
  header.parameters.align.store_double = job.store_double;
  return std::visit(
      [&](const auto& input) -> Result<void> {
        header.groups = {{stream.name, group_of(input), false, false, stream.files}};
        auto writer = KA_TRY(
            TakeNpzWriter::create(job.files, job.to, job.overwrite, header, NpzNames::plain));
        return write_rows(input, input.passes, header.frames, progress, writer);
      },
      stream.data);
}

/// Runs `write(sink)` into a new file and returns its findings.
template <class Write>
Result<Findings> put_bvh(const Job& job, const Write& write) {
  // The file gets its name at commit(). A failed conversion therefore leaves an existing file as it
  // was.
  OutputFile out = KA_TRY(OutputFile::create(job.files, job.to, job.overwrite));
  Findings findings = KA_TRY(write([&out](std::string_view text) { return out.write(text); }));
  KA_TRY(out.commit());
  return findings;
}

// take_to_npz and take_to_bvh read HDF5 and run in a child process.

/// Writes all streams of a take into one NPZ; names of arrays begin with the stream's.
Result<void> take_to_npz(const Job& job) {
  TakeReader reader = KA_TRY(TakeReader::open(job.files, job.from));
  TakeHeader header = reader.header();
  // A take that stores 8-byte numbers keeps them; --double only widens.
  if (job.store_double) header.parameters.align.store_double = true;
  auto writer =
      KA_TRY(TakeNpzWriter::create(job.files, job.to, job.overwrite, header, NpzNames::by_stream));
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) KA_TRY(writer.append(slab));
  return writer.finish();
}

/// Converts a take in a child process, which returns its findings as a report's JSON.
Result<Findings> convert_in_child(const Job& job) {
  // Only text comes back from a child, so findings travel as the JSON of a report.
  const auto work = [&job]() -> Result<std::string> {
    Findings findings;
    if (job.to.ends_with(".npz")) {
      KA_TRY(take_to_npz(job));
    } else {
      findings = KA_TRY(put_bvh(
          job, [&job](const FileSink& sink) { return take_to_bvh(job.files, job.from, sink); }));
    }
    return "{\"findings\": " + findings_json(findings) + "}";
  };
  return report_findings(KA_TRY(run_guarded(GuardLimits{}, blame(job.from), work)), job.from);
}

/// Refuses the call (exit code 2) if a flag does not apply to the input.
Result<void> check_flags(const Convert& o, const RecordedStream* stream, Call& call) {
  auto used = o.stream.check_use(o.from.front(), stream, call.sources);
  return used ? Result<void>{} : call.console.refuse(std::move(used).error());
}

Result<Findings> convert_take(const Job& job, const Convert& o, Call& call) {
  KA_TRY(check_flags(o, nullptr, call));
  // Only a child process may read a take, because a damaged one can crash HDF5.
  if (!job.to.ends_with(".mcap")) return convert_in_child(job);
  return call.console.refuse(
      Error{job.to, 0, "a name that ends in .npz or .bvh, for a take", "another extension"});
}

/// The findings of a file that several streams share appear once, at the first of these streams.
Findings findings_of(const Recording& recording) {
  Findings all;
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    if (const SharedFile* file = newly_read_file(recording, i)) append(all, file->findings);
    const RecordedStream& stream = recording.streams[i];
    append(all, with_stream_name(stream, recording, all_findings(stream)));
  }
  return all;
}

/// Converts all devices of a recording whose data can be read as rows, and the recording's own
/// marks.
Result<Findings> convert_recording(const Job& job, const Convert& o, Call& call) {
  const Progress progress = call.console.progress();
  // The devices of a recording have no common grid of stamps. Only `align` can make arrays of them.
  if (!job.to.ends_with(".mcap")) {
    return call.console.refuse(
        Error{job.to, 0, "a name that ends in .mcap, for a recording",
              "another extension (kinalign align makes a take of a recording)"});
  }
  KA_TRY(check_flags(o, nullptr, call));
  const auto source = KA_TRY(
      RecordingSource::open(job.files, job.from, RecordingSource::Devices::learned, {}, progress));
  const Manifest manifest = KA_TRY(recorded_manifest(source->survey(), job.from));
  // One device that can't be read must not keep the others from being shown. It becomes a warning.
  const OpenedInPart opened = KA_TRY(open_what_can_be(
      job.files, manifest, std::string(folder(job.from)), {progress, call.jobs, source}));
  KA_TRY(
      show_recording(job.files, opened.recording, {source.get(), job.to, job.overwrite}, progress));
  Findings findings = findings_of(opened.recording);
  append(findings, opened.left_out);
  return findings;
}

Result<Findings> convert_xdf(const Job& job, const Convert& o, Call& call) {
  if (!job.to.ends_with(".mcap")) {
    return call.console.refuse(
        Error{job.to, 0, "a name that ends in .mcap, for an XDF file", "another extension"});
  }
  // An XDF describes its own streams, so no flag of a stream applies.
  KA_TRY(check_flags(o, nullptr, call));
  return KA_TRY(show_xdf(job.files, job.from, job.to, job.overwrite, call.console.progress()))
      .findings;
}

/// Converts the file of a single stream.
Result<Findings> convert_stream(const Job& job, const Convert& o, Call& call) {
  const Input input = KA_TRY(open_input(job.files, job.from, o.stream, call.console.progress()));
  const RecordedStream& stream = input.recording.streams.front();
  KA_TRY(check_flags(o, &stream, call));
  call.console.detail(harmless(read_as(stream)));
  // BVH to BVH copies the text's values, so no number is rounded on its way through a clip.
  if (job.to.ends_with(".bvh")) {
    return put_bvh(job, [&](const FileSink& sink) {
      return copy_bvh(job.files, job.from, sink, call.console.progress());
    });
  }
  if (job.to.ends_with(".mcap")) {
    KA_TRY(show_recording(job.files, input.recording, {nullptr, job.to, job.overwrite},
                          call.console.progress()));
  } else {
    KA_TRY(stream_to_npz(job, stream, call.console.progress()));
  }
  // The recording has one stream, and `findings` holds those of its file as well.
  return stream.findings;
}

/// Chooses the conversion by the kind of the input.
Result<Findings> convert(const Job& job, const Convert& o, Call& call) {
  switch (KA_TRY(kind_of_file(job.files, job.from))) {
    case FileKind::recording:
      return convert_recording(job, o, call);
    case FileKind::xdf:
      return convert_xdf(job, o, call);
    case FileKind::take:
      return convert_take(job, o, call);
    case FileKind::manifest:
      return call.console.refuse(Error{job.from, 0, "a take, or one stream's file", "a manifest"});
    case FileKind::stream:
    case FileKind::model:    // contains no motion: opening it fails with that message
    case FileKind::unknown:  // opening it fails with the reason, unless --layout states its format
      break;
  }
  return convert_stream(job, o, call);
}

/// Converts a file. The sibling files of a recording are inputs, too, and never overwritten.
Result<int> run(Convert& o, Call& call) {
  call.console.if_it_fails(
      [](const Error&) { return std::vector<std::string>{"nothing was written"}; });
  const Job job{call.surroundings.files, o.from.front(), o.to.front(), call.common.overwrite(),
                o.store_double};
  // The parts of a recording lie next to it under derived names. The new file must not take one of
  // them.
  KA_TRY(keep_inputs(job.to, with_siblings(call.surroundings.files, {job.from})));
  const Findings findings = KA_TRY(convert(job, o, call));
  call.console.wrote(job.to);
  call.console.print(harmless(job.to) + "\n" + finding_lines(findings, call.console));
  call.console.print_json(json_text(nlohmann::ordered_json{
      {"written", true},
      {"file", job.to},
      {"findings", nlohmann::ordered_json::parse(findings_json(findings))}}));
  return code_of(findings);
}

}  // namespace

/// The verb `kinalign convert`.
Verb convert_verb() {
  return make_verb<Convert>(
      {.name = "convert",
       .summary = "convert a file to another format",
       .text = "Converts a take to .npz or .bvh, any stream's file to .npz, .bvh to .bvh, and a "
               "recording, an XDF or a stream's file to an .mcap of JSON, which Foxglove and "
               "Lichtblick show. Exit code 1 if there were warnings.",
       .examples = {{"kinalign convert demo/mocap.bvh demo/mocap.npz",
                     "positions, local_positions, local_rotations, joint_names, ... for NumPy"},
                    {"kinalign convert demo/take.h5 demo/take.npz", "all streams of a take"},
                    {"kinalign convert demo/take.h5 demo/aligned.bvh",
                     "the take's skeleton stream"},
                    {"kinalign convert takes/03_S1A02_01.mcap shown.mcap",
                     "skeletons, samples and marks, to view in Lichtblick"}},
       .common = {"force", "json"}},
      describe_convert, run);
}

}  // namespace kinalign
