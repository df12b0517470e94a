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

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// The options of `kinalign convert`. Both lists have exactly one word.
struct Convert {
  std::vector<std::string> from, to;  // one word each
  bool store_double = false;          // true: an NPZ gets numbers of 8 bytes
  StreamFlags stream;
};

/// The command line of `kinalign convert`. The ending of the new file's name decides its format.
Usage describe_convert(Convert& o) {
  Usage usage;
  usage.positionals = {
      {"IN", "a take, a recording, or a stream's file", &o.from},
      {"OUT", "a new file; its extension .npz, .bvh or .mcap decides the format", &o.to}};
  usage.flags = o.stream.fields();
  usage.flags.push_back({"double", "store 8-byte numbers instead of 4-byte ones", &o.store_double});
  usage.check = [&o](const Common&, const Sources&) -> Result<void> {
    // The format of the new file follows from its ending only, so an unknown ending is refused.
    const std::string& to = o.to.front();
    if (!to.ends_with(".npz") && !to.ends_with(".bvh") && !to.ends_with(".mcap")) {
      return Failure(Error{to, 0, "a name that ends in .npz, .bvh or .mcap", "another extension"});
    }
    if (o.store_double && !to.ends_with(".npz")) {
      return Failure(Error{"--double", 0, "a new file that ends in .npz", shown(to)});
    }
    return o.stream.stream({}).map([](const StreamOptions&) {});
  };
  return usage;
}

/// One conversion of a file into a new file. `files` must live longer than the job.
struct Job {
  FileSystem& files;
  std::string from, to;
  Overwrite overwrite;
  bool store_double = false;
};

/// Brings rows of a stream into the form that a take stores. There is one overload for each of the
/// three kinds of streams, so that write_rows() and stream_to_npz() work for all kinds.
ClipRows rows_of(const ClipInput& input, ClipFrames& block) {
  return own_rows(input.skeleton, std::move(block));
}

PointRows rows_of(const PointInput&, PointFrames& block) { return own_rows(std::move(block)); }

// The last member, the distance of each sample from its raw sample, stays empty, because recorded
// rows were not resampled.
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

/// Writes all rows of a stream to an NPZ, block by block. The lengths of the arrays in an NPZ must
/// be known before the first row, so `frames` is the number of rows that the survey counted.
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
    // `first` is the index of the block's first row in the whole file.
    slab.first += slab.stamps.size();
    if (!go_on(progress, "converting", slab.first, frames)) return Failure(interruption());
  }
  return writer.finish();
}

/// Writes the file of one stream as an NPZ. The names of the arrays have no prefix.
Result<void> stream_to_npz(const Job& job, const RecordedStream& stream, const Progress& progress) {
  TakeHeader header;
  // All rows were counted when the file was opened, so the lengths of the arrays are known.
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

/// Calls `write` with a function that writes into a new file. Returns the findings of `write`.
template <class Write>
Result<Findings> put_bvh(const Job& job, const Write& write) {
  // The file gets its name in commit(). If the conversion fails, an existing file stays as it was.
  OutputFile out = KA_TRY(OutputFile::create(job.files, job.to, job.overwrite));
  Findings findings = KA_TRY(write([&out](std::string_view text) { return out.write(text); }));
  KA_TRY(out.commit());
  return findings;
}

// take_to_npz() and take_to_bvh() read HDF5, so they run in a child process.

/// Writes all streams of a take into one NPZ. The name of each array begins with the stream's name.
Result<void> take_to_npz(const Job& job) {
  TakeReader reader = KA_TRY(TakeReader::open(job.files, job.from));
  TakeHeader header = reader.header();
  // If the take has numbers of 8 bytes, the NPZ has them even without --double.
  if (job.store_double) header.parameters.align.store_double = true;
  auto writer =
      KA_TRY(TakeNpzWriter::create(job.files, job.to, job.overwrite, header, NpzNames::by_stream));
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) KA_TRY(writer.append(slab));
  return writer.finish();
}

/// Converts a take in a child process.
Result<Findings> convert_in_child(const Job& job) {
  // A child process returns only text, so the findings come back as the JSON of a report.
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

Result<Findings> convert_take(const Job& job, const Convert& o, Call& call) {
  KA_TRY(o.stream.check_use(o.from.front(), nullptr, call));
  // A damaged take can crash HDF5, so only a child process may read a take.
  if (!job.to.ends_with(".mcap")) return convert_in_child(job);
  return call.console.refuse(
      Error{job.to, 0, "a name that ends in .npz or .bvh, for a take", "another extension"});
}

/// All findings of a recording. If several streams come from one file, the file's findings are
/// listed once.
Findings findings_of(const Recording& recording) {
  Findings all;
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    if (const SharedFile* file = newly_read_file(recording, i)) append(all, file->findings);
    const RecordedStream& stream = recording.streams[i];
    append(all, with_stream_name(stream, recording, all_findings(stream)));
  }
  return all;
}

/// Converts a recording: all devices whose data can be read as rows, and the recording's marks.
Result<Findings> convert_recording(const Job& job, const Convert& o, Call& call) {
  const Progress progress = call.console.progress();
  // The devices of a recording have different stamps. Only `align` makes arrays with common stamps.
  if (!job.to.ends_with(".mcap")) {
    return call.console.refuse(
        Error{job.to, 0, "a name that ends in .mcap, for a recording",
              "another extension (kinalign align makes a take of a recording)"});
  }
  KA_TRY(o.stream.check_use(o.from.front(), nullptr, call));
  const auto source = KA_TRY(
      RecordingSource::open(job.files, job.from, RecordingSource::Devices::learned, {}, progress));
  const Manifest manifest = KA_TRY(recorded_manifest(source->survey(), job.from));
  // If one device can't be read, that is a warning, and the other devices are converted.
  const OpenedInPart opened = KA_TRY(open_what_can_be(
      job.files, manifest, std::string(folder(job.from)), {progress, call.jobs, source}));
  const Findings left_out = KA_TRY(
      show_recording(job.files, opened.recording, {source.get(), job.to, job.overwrite}, progress));
  Findings findings = findings_of(opened.recording);
  append(findings, opened.left_out);
  append(findings, left_out);
  return findings;
}

Result<Findings> convert_xdf(const Job& job, const Convert& o, Call& call) {
  if (!job.to.ends_with(".mcap")) {
    return call.console.refuse(
        Error{job.to, 0, "a name that ends in .mcap, for an XDF file", "another extension"});
  }
  // An XDF file describes its streams itself, so no flag that describes a stream is allowed.
  KA_TRY(o.stream.check_use(o.from.front(), nullptr, call));
  return show_xdf(job.files, job.from, job.to, job.overwrite, call.console.progress());
}

/// Converts the file of a single stream.
Result<Findings> convert_stream(const Job& job, const Convert& o, Call& call) {
  const Input input = KA_TRY(open_input(job.files, job.from, o.stream, call.console.progress()));
  const RecordedStream& stream = input.recording.streams.front();
  KA_TRY(o.stream.check_use(o.from.front(), &stream, call));
  call.console.detail(harmless(read_as(stream)));
  // From BVH to BVH the numbers are copied as text, so that none is rounded.
  if (job.to.ends_with(".bvh")) {
    return put_bvh(job, [&](const FileSink& sink) {
      return copy_bvh(job.files, job.from, sink, call.console.progress());
    });
  }
  Findings left_out;
  if (job.to.ends_with(".mcap")) {
    left_out = KA_TRY(show_recording(job.files, input.recording, {nullptr, job.to, job.overwrite},
                                     call.console.progress()));
  } else {
    KA_TRY(stream_to_npz(job, stream, call.console.progress()));
  }
  // `findings` of the single stream include the findings of its file.
  Findings findings = stream.findings;
  append(findings, left_out);
  return findings;
}

/// Chooses the conversion by the kind of the input file.
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
    case FileKind::model:    // a model contains no motion: opening it fails with that message
    case FileKind::unknown:  // opening fails with the reason, unless --layout states the format
      break;
  }
  return convert_stream(job, o, call);
}

/// Converts a file. The parts of a recording in several files are inputs, too, and are never
/// overwritten.
Result<int> run(Convert& o, Call& call) {
  call.console.advise("nothing was written");
  const Job job{call.surroundings.files, o.from.front(), o.to.front(), call.common.overwrite(),
                o.store_double};
  // The parts of a recording lie in its folder. The new file must not have the name of a part.
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
