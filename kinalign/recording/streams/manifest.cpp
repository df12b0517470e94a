// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/protocols.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/recording/streams/senders.h"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <vector>

namespace kinalign {

namespace {

/// The order of streams in a manifest. Mocap comes first, because it is most accurate and has the
/// highest rate. The stamps of the first stream become the times of the take.
constexpr int kinect_rank = 1;
constexpr int last_rank = 2;
int rank_of(std::optional<Protocol> protocol) {
  if (!protocol) return last_rank;
  switch (row_of(*protocol).rows) {
    case ProtocolRows::clip:
      return 0;
    case ProtocolRows::points:
      return kinect_rank;
    case ProtocolRows::imu:
      break;
  }
  return last_rank;
}

bool is_named_by_address(const RawChannel& raw) {
  const auto protocol = protocol_of(raw);
  return protocol && row_of(*protocol).is_named_by_address;
}

/// The data that distinguish the devices of one stream.
struct Nodes {
  // The sensors of SlimeVR trackers that sent rotations, one bit each; the key is the address.
  std::map<std::string, std::uint32_t> sensors;
  std::map<std::string, std::set<std::string>> called;  // ids of nodes; the key is from called()
};
/// The key of Nodes::called. `name` is an id or a place on the body. Both share one map, because a
/// place may equal another node's id.
std::string called(const RawChannel& raw, const std::string& name) {
  return raw.stream + "/" + name;
}

/// Collects the sensors and names of all devices in the recording.
Nodes nodes_in(const RecordingSurvey& survey) {
  Nodes nodes;
  for (const ChannelSurvey& one : survey.channels) {
    const auto raw = to_raw(one.channel);
    if (!raw) continue;
    // Several channels with the same address may contain a tracker's sensors.
    nodes.sensors[host_of(raw->sender)] |= one.sensors;
    for (const std::string& name : {raw->node, raw->place}) {
      if (!name.empty()) nodes.called[called(*raw, name)].insert(raw->node);
    }
  }
  return nodes;
}

/// The names of one stream's devices in a manifest. A tracker's name is its address, followed by
/// the sensor's number if the tracker has several sensors. A node's name is its place if no other
/// node has the same place. Mocap and Kinects have empty names, because the first pass finds the
/// device.
std::vector<std::string> node_names(const RawChannel& raw, const Nodes& nodes) {
  if (!is_named_by_address(raw)) {
    const bool has_place =
        !raw.place.empty() && nodes.called.at(called(raw, raw.place)).size() == 1;
    return {has_place ? raw.place : raw.node};
  }
  const std::string host = host_of(raw.sender);
  const std::uint32_t sensors = nodes.sensors.at(host);
  // If there is only one sensor, the address needs no number.
  if (std::popcount(sensors) < 2) return {host};
  std::vector<std::string> names;
  for (unsigned k = 0; k < 32; ++k) {
    if ((sensors >> k & 1U) != 0) names.push_back(host + "/" + std::to_string(k));
  }
  return names;
}

/// Adds each name once, because a node may have had several addresses.
void add_nodes(const std::string& path, const std::vector<std::string>& names,
               std::vector<StreamFile>& files) {
  for (const std::string& name : names) {
    const auto same = [&](const StreamFile& file) { return file.node == name; };
    if (std::none_of(files.begin(), files.end(), same)) files.push_back({path, name});
  }
}

}  // namespace

Result<Manifest> manifest_of(const RecordingSurvey& survey, const std::string& path) {
  if (!survey.facts)
    return Failure(Error{path, 0, "a recording by kinalign record", "another MCAP file"});
  struct Device {
    int rank = 0;
    StreamOptions options;
  };
  std::vector<Device> devices;
  const Nodes nodes = nodes_in(survey);
  const bool some_rotate = std::any_of(nodes.sensors.begin(), nodes.sensors.end(),
                                       [](const auto& tracker) { return tracker.second != 0; });
  for (const ChannelSurvey& one : survey.channels) {
    const auto raw = to_raw(one.channel);
    if (!raw || raw->protocol == exchange_encoding || one.messages == 0) continue;
    // A port for trackers may also receive packets of other programs, which contain no rotations.
    // If any tracker sent rotations, addresses without rotations are not trackers.
    if (is_named_by_address(*raw) && one.sensors == 0 && some_rotate) continue;
    auto device = std::find_if(devices.begin(), devices.end(),
                               [&](const Device& d) { return d.options.name == raw->stream; });
    if (device == devices.end()) {
      // New devices are added at the end, in the order of channels. They are sorted by rank below.
      device = devices.insert(device, {rank_of(protocol_of(*raw)), {}});
      device->options.name = raw->stream;
      device->options.select = {{"stream", raw->stream}};
    }
    add_nodes(path, node_names(*raw, nodes), device->options.files);
  }
  if (devices.empty()) {
    return Failure(
        Error{path, 0, "data of at least one device", "none", ErrorKind::no_rows_in_recording});
  }
  std::stable_sort(devices.begin(), devices.end(),
                   [](const Device& a, const Device& b) { return a.rank < b.rank; });
  Manifest manifest;
  manifest.subject = survey.facts->subject;
  manifest.action = survey.facts->action;
  for (Device& device : devices) {
    // A Kinect has its own space. If an earlier stream has joints, the Kinect is fitted to the
    // space of that stream.
    const bool follows = !manifest.streams.empty() && devices.front().rank <= kinect_rank;
    if (follows && device.rank == kinect_rank) manifest.spaces[device.options.name].method = "fit";
    manifest.streams.push_back(std::move(device.options));
  }
  return manifest;
}

}  // namespace kinalign
