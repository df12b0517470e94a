// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/node_source.h"

#include "kinalign/align/nodes.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/sources/formats.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace kinalign {

namespace {

// The largest number of samples of all nodes together. The limit protects the memory.
constexpr std::size_t most_samples = std::size_t{1} << 26U;
constexpr std::string_view nodes_kind = "inertial nodes";

/// References to a block of rows with S nodes, from a reader or a take. All arrays have the shape
/// [row, S]. An empty array means that the quantity was not measured.
struct NodeBlock {
  const std::vector<Time>& stamps;
  const std::vector<double>&orientation, &acceleration, &angular_velocity;
  const std::vector<std::uint8_t>& valid;
};

/// Appends one sample from an array with `width` numbers for each sample. Does nothing if the
/// quantity was not measured.
void append_numbers(const std::vector<double>& from, std::size_t i, std::size_t width,
                    std::vector<double>& to) {
  if (from.empty()) return;
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(i * width);
  to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
}

/// Appends a block to the tracks from index `first` on. Invalid samples and samples whose stamps do
/// not rise are left out.
Result<void> append_block(const NodeBlock& block, std::size_t first, NamedNodes& out) {
  if (block.stamps.empty()) return {};
  const std::size_t nodes = block.valid.size() / block.stamps.size();
  // Sample i belongs to node i % S and to stamp i / S.
  for (std::size_t i = 0; i < block.valid.size(); ++i) {
    NodeTrack& track = out.tracks[first + i % nodes];
    const Time stamp = block.stamps[i / nodes];
    // Resampling searches the stamps of a track, so they must rise. A sample with a repeated stamp
    // is dropped.
    if (block.valid[i] == 0 || (!track.stamps.empty() && stamp <= track.stamps.back())) continue;
    // The product may be larger than the true number of samples, but needs no extra counter.
    if (track.stamps.size() * out.tracks.size() > most_samples) {
      return Failure(Error{"", 0, "a stream that fits into memory", "a longer stream"});
    }
    track.stamps.push_back(stamp);
    append_numbers(block.orientation, i, 4, track.orientation);
    append_numbers(block.acceleration, i, 3, track.acceleration);
    append_numbers(block.angular_velocity, i, 3, track.angular_velocity);
  }
  return {};
}

/// Adds an empty track for each node. `worn`: the mounting of each node (sensor_from_bone), if the
/// manifest states it.
void add_tracks(const std::vector<std::string>& names, const ImuContent& content,
                const std::vector<std::optional<Quat>>& worn, NamedNodes& out) {
  for (const std::string& name : names) {
    out.names.push_back(name);
    out.tracks.emplace_back();
    out.tracks.back().gravity = content.gravity;
  }
  // `worn` has one element for each name, so all arrays of `out` have the same length.
  out.worn.insert(out.worn.end(), worn.begin(), worn.end());
}

/// The mountings of nodes that a manifest states. `is_applied`: the rows of the take are already
/// turned, so the mounting is the identity.
std::vector<std::optional<Quat>> worn_by(const StreamOptions& options,
                                         const std::vector<std::string>& names, bool is_applied) {
  std::vector<std::optional<Quat>> out;
  for (const std::string& name : names) {
    out.emplace_back();
    const auto stated = options.mounting.find(name);
    // A mounting is a quaternion w, x, y, z. An array of another length means that none is stated.
    if (stated == options.mounting.end() || stated->second.size() != 4) continue;
    // In a T-pose the axes of the bone are those of the world.
    out.back() = is_applied ? Quat::Identity() : quat(stated->second, 0).normalized().conjugate();
  }
  return out;
}

/// The index of the take's group of nodes: the wanted one, or the only one.
Result<std::size_t> node_group_of(const TakeHeader& header, const std::string& path,
                                  const WantedStream& wanted) {
  std::vector<StreamChoice> all;
  for (std::size_t g = 0; g < header.groups.size(); ++g) {
    const TakeGroup& group = header.groups[g];
    if (std::holds_alternative<ImuGroup>(group.kind)) all.push_back({group.name, g});
  }
  return choose_stream(all, wanted, nodes_kind, path);
}

/// The streams of nodes with the wanted name. If no name is given, all streams must have the same
/// name.
Result<std::vector<const RecordedStream*>> node_streams(const Recording& recording,
                                                        const std::string& path,
                                                        const WantedStream& wanted) {
  const auto& streams = recording.streams;
  std::vector<StreamChoice> all;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const bool is_known = std::any_of(all.begin(), all.end(), [&](const StreamChoice& one) {
      return one.name == streams[i].name;
    });
    if (std::holds_alternative<ImuInput>(streams[i].data) && !is_known) {
      all.push_back({streams[i].name, i});
    }
  }
  const std::string& name = streams[KA_TRY(choose_stream(all, wanted, nodes_kind, path))].name;
  std::vector<const RecordedStream*> out;
  for (const RecordedStream& one : streams) {
    if (std::holds_alternative<ImuInput>(one.data) && one.name == name) out.push_back(&one);
  }
  return out;
}

/// Reads all samples of a stream. Their stamps are in the time of the take.
Result<void> read_nodes(const RecordedStream& stream, const ImuInput& input, std::size_t first,
                        NamedNodes& out) {
  const auto pass = KA_TRY(input.passes());
  ImuSamples block;
  while (KA_TRY(pass(block))) {
    // Each stream has its own clock. Only in the time of the take can stamps of several devices be
    // compared.
    for (Time& stamp : block.stamps) stamp = take_time(stream.clock, stamp);
    KA_TRY(append_block(
        {block.stamps, block.orientation, block.acceleration, block.angular_velocity, block.valid},
        first, out));
  }
  return {};
}

}  // namespace

Result<NamedNodes> nodes_of_take(FileSystem& files, const std::string& path,
                                 const WantedStream& stream) {
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  const std::size_t wanted = KA_TRY(node_group_of(reader.header(), path, stream));
  const auto group = std::get<ImuGroup>(reader.header().groups[wanted].kind);
  NamedNodes out{reader.header().groups[wanted].name, {}, {}, {}};
  const StreamOptions& options = options_of(reader.header().parameters, out.stream);
  add_tracks(group.node_names, group.content, worn_by(options, group.node_names, true), out);
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) {
    auto& rows = std::get<ImuRows>(slab.rows[wanted]);
    // A take may give all nodes relative to the root's node. The model needs each node in its own
    // coordinates.
    if (!group.root_node.empty()) bring_from_root(group, rows);
    KA_TRY(append_block(
        {slab.stamps, rows.orientation, rows.acceleration, rows.angular_velocity, rows.valid}, 0,
        out));
  }
  return out;
}

/// If each node is a device with its own stream, all streams of the same name form one set of
/// nodes.
Result<NamedNodes> nodes_of(const std::string& path, const WantedStream& stream, Call& call) {
  FileSystem& files = call.surroundings.files;
  if (KA_TRY(kind_of_file(files, path)) == FileKind::take)
    return nodes_of_take(files, path, stream);
  const Input input = KA_TRY(open_motion(path, call));
  const auto streams = KA_TRY(node_streams(input.recording, path, stream));
  NamedNodes out{streams.front()->name, {}, {}, {}};
  for (const RecordedStream* one : streams) {
    const auto& nodes = std::get<ImuInput>(one->data);
    // The tracks from index `first` on belong to this stream.
    const std::size_t first = out.tracks.size();
    const StreamOptions options =
        input.manifest ? options_of(*input.manifest, one->name) : StreamOptions{};
    add_tracks(nodes.node_names, nodes.content, worn_by(options, nodes.node_names, false), out);
    KA_TRY(read_nodes(*one, nodes, first, out));
    for (std::string& warning : warnings_of(*one)) out.warnings.push_back(std::move(warning));
  }
  return out;
}

}  // namespace kinalign
