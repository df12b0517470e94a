// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/point_source.h"

#include "kinalign/align/own_rows.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/sources/formats.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace kinalign {

namespace {

// The largest number of frames times joints. The limit protects the memory.
constexpr std::size_t most_values = std::size_t{1} << 29U;
constexpr std::string_view joints_kind = "joints";

/// Appends the rows whose stamps rise. All other rows are only counted.
Result<void> append(NamedPoints& out, const std::vector<Time>& stamps,
                    const std::vector<double>& positions, const std::vector<Tracking>& state) {
  const std::size_t joints = out.joints.size();
  // The limit is for frames times joints; each of them has three doubles.
  if ((out.frames.size() + stamps.size()) * joints > most_values) {
    return Failure(Error{"", 0, "a stream that fits into memory", "a longer stream"});
  }
  for (std::size_t t = 0; t < stamps.size(); ++t) {
    if (!out.frames.stamps.empty() && stamps[t] <= out.frames.stamps.back()) {
      ++out.left_out;
      continue;
    }
    out.frames.stamps.push_back(stamps[t]);
    // `row` and `count` count joints. Each joint has three numbers in the positions.
    const auto row = static_cast<std::ptrdiff_t>(t * joints),
               count = static_cast<std::ptrdiff_t>(joints);
    out.frames.positions.insert(out.frames.positions.end(), positions.begin() + 3 * row,
                                positions.begin() + 3 * (row + count));
    out.frames.state.insert(out.frames.state.end(), state.begin() + row,
                            state.begin() + row + count);
  }
  return {};
}

/// Makes the states of a skeleton's joints, which have none: "tracked" in valid rows, "missing" in
/// others. If `valid` is empty, all rows are valid.
std::vector<Tracking> all_tracked(std::size_t rows, std::size_t joints,
                                  const std::vector<std::uint8_t>& valid) {
  std::vector<Tracking> out(rows * joints, Tracking::tracked);
  for (std::size_t i = 0; i < out.size() && !valid.empty(); ++i) {
    if (valid[i / joints] == 0) out[i] = Tracking::missing;
  }
  return out;
}

/// The states of a group of points. A joint that is marked as invalid becomes missing.
std::vector<Tracking> where_valid(const PointRows& rows) {
  std::vector<Tracking> out = rows.state;
  for (std::size_t i = 0; i < out.size() && i < rows.valid.size(); ++i) {
    if (rows.valid[i] == 0) out[i] = Tracking::missing;
  }
  return out;
}

/// The index of the wanted group in a take. If no name is given, the only group of points.
Result<std::size_t> group_of(const TakeHeader& header, const std::string& path,
                             const WantedStream& wanted) {
  std::vector<StreamChoice> all;
  for (std::size_t g = 0; g < header.groups.size(); ++g) {
    const TakeGroup& group = header.groups[g];
    // The user may also choose a skeleton by its name. Without a name only groups of points are
    // considered.
    const bool is_usual = std::holds_alternative<PointGroup>(group.kind);
    if (!std::holds_alternative<ImuGroup>(group.kind)) all.push_back({group.name, g, is_usual});
  }
  return choose_stream(all, wanted, joints_kind, path);
}

/// Finds the wanted stream. If no name is given: the only stream of points, or the only stream in
/// the file, even if it is a skeleton.
Result<const RecordedStream*> stream_of(const Recording& recording, const std::string& path,
                                        const WantedStream& wanted) {
  const auto& streams = recording.streams;
  std::vector<StreamChoice> all;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const bool is_usual =
        streams.size() == 1 || std::holds_alternative<PointInput>(streams[i].data);
    if (!std::holds_alternative<ImuInput>(streams[i].data)) {
      all.push_back({streams[i].name, i, is_usual});
    }
  }
  return &streams[KA_TRY(choose_stream(all, wanted, joints_kind, path))];
}

/// Reads all frames of a stream of points. Their stamps are in the time of the take.
Result<void> read_points(const TimeModel& clock, const PointInput& input, NamedPoints& out) {
  out.joints = input.joint_names;
  const auto pass = KA_TRY(input.passes());
  PointFrames block;
  while (KA_TRY(pass(block))) {
    for (Time& stamp : block.stamps) stamp = take_time(clock, stamp);
    KA_TRY(append(out, block.stamps, block.positions, block.state));
  }
  return {};
}

/// Reads all frames of a skeleton as global positions of its joints.
Result<void> read_clip(const TimeModel& clock, const ClipInput& input, NamedPoints& out) {
  out.joints = input.skeleton.joint_names;
  const auto pass = KA_TRY(input.passes());
  ClipFrames block;
  while (KA_TRY(pass(block))) {
    std::vector<Time> stamps = block.stamps;
    for (Time& stamp : stamps) stamp = take_time(clock, stamp);
    const ClipRows rows = own_rows(input.skeleton, std::move(block));
    KA_TRY(append(out, stamps, rows.positions, all_tracked(stamps.size(), out.joints.size(), {})));
    // The rows were moved out of the block, so the next turn of the loop gets an empty one.
    block = {};
  }
  return {};
}

}  // namespace

Result<NamedPoints> points_of_take(FileSystem& files, const std::string& path,
                                   const WantedStream& stream) {
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  const std::size_t wanted = KA_TRY(group_of(reader.header(), path, stream));
  const TakeGroup& group = reader.header().groups[wanted];
  NamedPoints out{group.name, {}, {}};
  if (const auto* points = std::get_if<PointGroup>(&group.kind)) out.joints = points->joint_names;
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
    out.joints = clip->skeleton.joint_names;
  }
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) {
    // A group has the same kind in all blocks, so it is always either points or a skeleton.
    if (const auto* rows = std::get_if<PointRows>(&slab.rows[wanted])) {
      KA_TRY(append(out, slab.stamps, rows->positions, where_valid(*rows)));
    } else if (const auto* clip = std::get_if<ClipRows>(&slab.rows[wanted])) {
      KA_TRY(append(out, slab.stamps, clip->positions,
                    all_tracked(slab.stamps.size(), out.joints.size(), clip->valid)));
    }
  }
  return out;
}

Result<NamedPoints> points_of(const std::string& path, const WantedStream& stream, Call& call) {
  FileSystem& files = call.surroundings.files;
  if (KA_TRY(kind_of_file(files, path)) == FileKind::take) {
    return points_of_take(files, path, stream);
  }
  const Input input = KA_TRY(open_motion(path, call));
  const RecordedStream* found = KA_TRY(stream_of(input.recording, path, stream));
  NamedPoints out{found->name, {}, {}};
  if (const auto* points = std::get_if<PointInput>(&found->data)) {
    KA_TRY(read_points(found->clock, *points, out));
  } else {
    KA_TRY(read_clip(found->clock, std::get<ClipInput>(found->data), out));
  }
  out.warnings = warnings_of(*found);
  return out;
}

double share_of(const std::vector<std::uint8_t>& seen, std::uint8_t state) {
  return static_cast<double>(std::count(seen.begin(), seen.end(), state)) /
         static_cast<double>(std::max<std::size_t>(seen.size(), 1));
}

std::vector<std::string> warnings_of(const NamedPoints& points, const EvenFrames& frames) {
  std::vector<std::string> out = points.warnings;
  if (points.left_out > 0) {
    out.push_back(fmt::format("{} frames are left out: their stamps repeat or step back",
                              grouped(points.left_out)));
  }
  // The next two warnings mean that the Kinect took another object for a joint or for the person.
  if (frames.far > 0) {
    out.push_back(fmt::format("{} joints lie more than 1.6 m from the root and count as missing",
                              grouped(frames.far)));
  }
  if (frames.jump_s) {
    out.push_back(fmt::format(
        "the body jumps at {:.1f} s, perhaps to another person; after that the answer may be wrong",
        *frames.jump_s));
  }
  return out;
}

}  // namespace kinalign
