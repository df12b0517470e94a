// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"
#include "apps/kinalign/describe_file.h"
#include "apps/kinalign/inputs.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/io/bvh_copy.h"
#include "kinalign/io/take_hdf5.h"
#include "kinalign/io/take_npz.h"
#include "kinalign/motion/kinematics.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

struct Convert {
  std::vector<std::string> from, to;  // one each
  bool store_double = false;
  StreamFlags stream;
};

Usage describe_convert(Convert& o) {
  Usage usage;
  usage.positionals = {{"IN", "a take, or a stream's file", &o.from},
                       {"OUT", "a new file; its ending, .npz or .bvh, decides", &o.to}};
  usage.flags = o.stream.fields();
  usage.flags.push_back({"double", "store 8-byte numbers instead of 4-byte ones", &o.store_double});
  return usage;
}

struct Job {
  FileSystem& files;
  std::string from, to;
  Overwrite overwrite;
};

/// Rows of a stream as a take would hold them.
ClipRows rows_of(const ClipInput& input, ClipFrames& block) {
  ClipRows rows;
  rows.positions.resize(block.size() * input.skeleton.joints() * 3);
  forward_kinematics(input.skeleton, block, rows.positions);
  rows.local_positions = std::move(block.local_positions);
  rows.local_rotations = std::move(block.local_rotations);
  return rows;
}

PointRows rows_of(const PointInput&, PointFrames& block) {
  PointRows rows;
  rows.positions = std::move(block.positions);
  for (const Tracking state : block.state) rows.valid.push_back(state != Tracking::missing ? 1 : 0);
  rows.state = std::move(block.state);
  return rows;
}

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

template <class Input, class Frames>
Result<void> write_rows(const Input& input, const Passes<Frames>& passes, TakeNpzWriter& writer) {
  const Pass<Frames> pass = KA_TRY(passes());
  Frames block;
  TakeSlab slab;
  while (KA_TRY(pass(block))) {
    slab.stamps = block.stamps;
    slab.rows = {rows_of(input, block)};
    KA_TRY(writer.append(slab));
    slab.first += slab.stamps.size();
  }
  return writer.finish();
}

Result<void> stream_to_npz(const Job& job, const RecordedStream& stream, bool store_double) {
  TakeHeader header;
  header.frames = stream.survey.samples;
  header.parameters.align.store_double = store_double;
  return std::visit(
      [&](const auto& input) -> Result<void> {
        header.groups = {{stream.name, group_of(input), false, false, stream.files}};
        auto writer = KA_TRY(
            TakeNpzWriter::create(job.files, job.to, job.overwrite, header, NpzNames::plain));
        return write_rows(input, input.passes, writer);
      },
      stream.data);
}

/// `write(sink)`; what is to be said of what was written, line by line.
template <class Write>
Result<std::string> put_bvh(const Job& job, const Write& write) {
  OutputFile out = KA_TRY(OutputFile::create(job.files, job.to, job.overwrite));
  const auto sink = [&out](std::string_view text) { return out.write(text); };
  const Findings findings = KA_TRY(write(sink));
  KA_TRY(out.commit());
  return finding_lines(findings);
}

// The two for takes run in a child process.

Result<void> take_to_npz(const Job& job) {
  TakeReader reader = KA_TRY(TakeReader::open(job.files, job.from));
  auto writer = KA_TRY(TakeNpzWriter::create(job.files, job.to, job.overwrite, reader.header(),
                                             NpzNames::by_stream));
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) KA_TRY(writer.append(slab));
  return writer.finish();
}

Failure other_ending(const Job& job) {
  return Failure(Error{job.to, 0, "a name that ends in .npz or .bvh", "another ending"});
}

// Both return what is to be said of the result.

Result<std::string> convert_take(const Job& job) {
  if (!job.to.ends_with(".npz") && !job.to.ends_with(".bvh")) return other_ending(job);
  const auto work = [&job]() -> Result<std::string> {
    const auto write = [&](const TextSink& sink) { return take_to_bvh(job.files, job.from, sink); };
    if (job.to.ends_with(".bvh")) return put_bvh(job, write);
    KA_TRY(take_to_npz(job));
    return std::string();
  };
  return run_guarded(GuardLimits{}, blame(job.from), work);
}

Result<std::string> convert_stream(const Job& job, const Convert& o, const Progress& progress) {
  const auto copy = [&](const TextSink& sink) {
    return copy_bvh(job.files, job.from, sink, progress);
  };
  if (job.to.ends_with(".bvh")) return put_bvh(job, copy);
  if (!job.to.ends_with(".npz")) return other_ending(job);
  const Recording input = KA_TRY(open_input(job.files, job.from, o.stream, progress));
  if (input.streams.size() == 1) {
    KA_TRY(stream_to_npz(job, input.streams.front(), o.store_double));
    return std::string();
  }
  return Failure(
      Error{job.from, 0, "one stream's file", fmt::format("{} streams", input.streams.size())});
}

Result<int> run(Convert& o, Call& call) {
  call.console.if_it_fails(
      [](const Error&) { return std::vector<std::string>{"nothing was written"}; });
  const Job job{call.surroundings.files, o.from.front(), o.to.front(), call.common.overwrite()};
  KA_TRY(keep_inputs(job.to, {job.from}));
  const std::string said = KA_TRY(KA_TRY(is_take(job.files, job.from))
                                      ? convert_take(job)
                                      : convert_stream(job, o, call.console.progress()));
  call.console.print(harmless(said + job.to + "\n"));
  call.console.print_json(R"({"written": true})");
  return said.empty() ? 0 : 1;
}

}  // namespace

Verb convert_verb() {
  return make_verb<Convert>(
      {.name = "convert",
       .summary = "one format into another",
       .text = "From a take to .npz or .bvh, from any stream's file to .npz, from .bvh to .bvh.",
       .examples = {{"kinalign convert walk.bvh walk.npz",
                     "positions, local_positions, local_rotations, joint_names, ... for NumPy"},
                    {"kinalign convert take.h5 take.npz", "all streams of a take"},
                    {"kinalign convert take.h5 mocap.bvh", "the take's skeleton stream"}},
       .common = {"force", "json"}},
      describe_convert, run);
}

}  // namespace kinalign
