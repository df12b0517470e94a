// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/take_files.h"

#include "kinalign/core/find_named.h"
#include "kinalign/dataset/export/csv_write.h"
#include "kinalign/formats/c3d/c3d.h"
#include "kinalign/formats/imu/opensim_sto.h"
#include "kinalign/formats/opensim/mot_write.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/take/take_bvh.h"
#include "kinalign/formats/take/take_npz.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

/// Writes one stream into `path`.
using WriteStream = Result<void> (*)(ExportedTake& take, std::size_t group, FileSystem& files,
                                     const std::string& path);

/// Writes a stream's points as TRC.
Result<void> write_trc(ExportedTake& take, std::size_t group, FileSystem& files,
                       const std::string& path) {
  const TakeHeader& header = take.header();
  TextOut out = KA_TRY(TextOut::create(files, path, Overwrite::no));
  auto writer = KA_TRY(TrcWriter::begin({names_of(header.groups[group]), take.rate_hz(),
                                         header.frames, std::string(file_name(path)), take.first()},
                                        out));
  KA_TRY(
      take.point_frames(group, [&](const PointFrames& frames) { return writer.append(frames); }));
  KA_TRY(writer.finish());
  return out.commit();
}

/// Writes a stream's points as C3D.
Result<void> write_c3d(ExportedTake& take, std::size_t group, FileSystem& files,
                       const std::string& path) {
  const TakeHeader& header = take.header();
  OutputFile out = KA_TRY(OutputFile::create(files, path, Overwrite::no));
  auto writer =
      KA_TRY(C3dWriter::begin({names_of(header.groups[group]), take.rate_hz(), header.frames},
                              [&out](std::string_view bytes) { return out.write(bytes); }));
  KA_TRY(
      take.point_frames(group, [&](const PointFrames& frames) { return writer.append(frames); }));
  KA_TRY(writer.finish());
  return out.commit();
}

/// Writes a skeleton's joint angles as MOT.
Result<void> write_mot(ExportedTake& take, std::size_t group, FileSystem& files,
                       const std::string& path) {
  const TakeHeader& header = take.header();
  TextOut out = KA_TRY(TextOut::create(files, path, Overwrite::no));
  // MOT stores joint angles; the group's skeleton gives their names.
  auto writer = KA_TRY(MotWriter::begin(
      {std::get<ClipGroup>(header.groups[group].kind).skeleton, header.frames, take.first()}, out));
  KA_TRY(take.clip_frames(group, [&](const ClipFrames& frames) { return writer.append(frames); }));
  KA_TRY(writer.finish());
  return out.commit();
}

/// Writes the orientations of nodes as STO.
Result<void> write_sto(ExportedTake& take, std::size_t group, FileSystem& files,
                       const std::string& path) {
  const auto& nodes = std::get<ImuGroup>(take.header().groups[group].kind);
  TextOut out = KA_TRY(TextOut::create(files, path, Overwrite::no));
  auto writer = KA_TRY(OpensimStoWriter::begin(
      {nodes.node_names, nodes.content, take.rate_hz(), take.first()}, out));
  KA_TRY(
      take.node_samples(group, [&](const ImuSamples& samples) { return writer.append(samples); }));
  return out.commit();
}

/// The next functions return why a format can't store a stream; an empty text means that it can.
std::string_view no_points(const TakeGroup& group) {
  return std::holds_alternative<ImuGroup>(group.kind) ? "the format holds points" : "";
}
std::string_view no_skeleton(const TakeGroup& group) {
  return std::holds_alternative<ClipGroup>(group.kind) ? "" : "the format holds a skeleton";
}
std::string_view no_orientation(const TakeGroup& group) {
  const auto* nodes = std::get_if<ImuGroup>(&group.kind);
  return nodes != nullptr && nodes->content.orientation ? ""
                                                        : "the format holds nodes' orientations";
}
std::string_view nothing(const TakeGroup&) { return ""; }

/// A format with a file for each stream.
struct StreamFormat {
  std::string_view ending;
  // Returns why the format can't store a stream; empty if it can.
  std::string_view (*refused)(const TakeGroup&);
  WriteStream write;
};

/// Writes each stream that the format can store. A stream that fails does not stop others.
Result<FilesMade> each_stream(ExportedTake& take, FileSystem& files, const std::string& stem,
                              const StreamFormat& format) {
  FilesMade made;
  const auto& groups = take.header().groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    // This check comes before a file is created, so that no empty file is left.
    const std::string_view why = format.refused(groups[g]);
    if (!why.empty()) {
      made.left_out.push_back(fmt::format("{}: {}", groups[g].name, why));
      continue;
    }
    const std::string path = fmt::format("{}_{}.{}", stem, groups[g].name, format.ending);
    const auto done = format.write(take, g, files, path);
    if (done) made.paths.push_back(path);
    if (!done && is_interruption(done.error())) return Failure(done.error());
    if (!done) made.failed.push_back(done.error());
  }
  return made;
}

/// One function for each format. All have the signature of TakeFormat::write, so some arguments are
/// not used.
template <const StreamFormat& format>
Result<FilesMade> as_streams(ExportedTake& take, FileSystem& files, const std::string&,
                             const std::string& stem) {
  return each_stream(take, files, stem, format);
}

constexpr StreamFormat trc{"trc", no_points, write_trc}, c3d{"c3d", no_points, write_c3d},
    mot{"mot", no_skeleton, write_mot}, sto{"sto", no_orientation, write_sto};

Result<FilesMade> as_csv(ExportedTake& take, FileSystem& files, const std::string&,
                         const std::string& stem) {
  FilesMade made = KA_TRY(each_stream(take, files, stem, {"csv", nothing, write_stream_csv}));
  // A table can't state skeletons and units, so these are written to a JSON file beside the tables.
  made.paths.push_back(stem + ".json");
  KA_TRY(write_streams_json(take, files, made.paths.back()));
  return made;
}

Result<FilesMade> as_npz(ExportedTake& take, FileSystem& files, const std::string&,
                         const std::string& stem) {
  const std::string path = stem + ".npz";
  auto writer =
      KA_TRY(TakeNpzWriter::create(files, path, Overwrite::no, take.header(), NpzNames::by_stream));
  KA_TRY(take.rows([&](const TakeSlab& slab) { return writer.append(slab); }));
  KA_TRY(writer.finish());
  return FilesMade{{path}, {}, {}};
}

/// Writes the first skeleton, because a BVH can have only one.
Result<FilesMade> as_bvh(ExportedTake& take, FileSystem& files, const std::string& take_path,
                         const std::string& stem) {
  FilesMade made;
  bool written = false;
  for (const TakeGroup& group : take.header().groups) {
    const bool is_first = !written && std::holds_alternative<ClipGroup>(group.kind);
    // Further skeletons and all other streams are left out.
    if (!is_first) {
      made.left_out.push_back(group.name + ": the format holds one skeleton");
      continue;
    }
    written = true;
    made.paths.push_back(fmt::format("{}_{}.bvh", stem, group.name));
    OutputFile out = KA_TRY(OutputFile::create(files, made.paths.back(), Overwrite::no));
    for (const Finding& lost : KA_TRY(take_to_bvh(
             files, take_path, [&out](std::string_view text) { return out.write(text); }))) {
      made.left_out.push_back(group.name + ": " + to_string(lost.what));
    }
    KA_TRY(out.commit());
  }
  return made;
}

}  // namespace

/// All formats of single takes, with the content that each can't store.
const std::vector<TakeFormat>& take_formats() {
  static const std::vector<TakeFormat> all{
      {"npz", "NumPy, all streams of a take in a file", "the report and the parameters", "a stream",
       as_npz},
      {"csv", "a table for each stream, and JSON of the skeletons", "the report and the parameters",
       "a stream", as_csv},
      {"bvh", "a take's skeleton",
       "points and nodes; stamps, which become an even step; which rows are valid", "a skeleton",
       as_bvh},
      {"trc", "points, and joints of skeletons as points",
       "rotations and nodes; inferred against tracked; intervals; the date", "points or a skeleton",
       as_streams<trc>},
      {"c3d", "points, and joints of skeletons as points",
       "rotations and nodes; inferred against tracked; intervals; stamps, which become an even "
       "step",
       "points or a skeleton", as_streams<c3d>},
      {"sto", "OpenSim: orientations of nodes",
       "accelerations and angular velocities; intervals; the date", "nodes with orientations",
       as_streams<sto>},
      {"mot", "OpenSim: joint angles of skeletons",
       "points and nodes; which rows are valid; intervals; the date", "a skeleton",
       as_streams<mot>}};
  return all;
}

const TakeFormat* find_take_format(std::string_view name) {
  return find_named(take_formats(), name);
}

}  // namespace kinalign
