// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_reader.h"

#include <algorithm>
#include <vector>

namespace kinalign {

namespace {

/// Mocap is the most exact and has the highest rate: its stamps become the grid.
constexpr int kinect_rank = 1;
int rank_of(std::string_view protocol) {
  if (protocol == "noitom" || protocol == "xsens") return 0;
  return protocol == "kinect" ? kinect_rank : 2;
}

/// What a manifest calls one of several that are a stream: trackers are told apart by their
/// addresses, and who sends no rotation is none; of mocap and Kinects listening finds the one.
std::string node_name(const RawChannel& raw) {
  if (raw.protocol == "slimevr") return host_of(raw.sender);
  return raw.place.empty() ? raw.node : raw.place;
}

}  // namespace

Result<Manifest> manifest_of(const RecordingSurvey& survey, const std::string& path) {
  if (!survey.facts)
    return Failure(Error{path, 0, "a recording of kinalign's", "another MCAP file"});
  struct Device {
    int rank = 0;
    StreamOptions options;
  };
  std::vector<Device> devices;
  const bool some_rotates = std::any_of(survey.channels.begin(), survey.channels.end(),
                                        [](const ChannelSurvey& one) { return one.rotates; });
  for (const ChannelSurvey& one : survey.channels) {
    const auto raw = to_raw(one.channel);
    if (!raw || raw->protocol == exchange_encoding || one.messages == 0) continue;
    if (raw->protocol == "slimevr" && !one.rotates && some_rotates) continue;
    auto device = std::find_if(devices.begin(), devices.end(),
                               [&](const Device& d) { return d.options.name == raw->stream; });
    if (device == devices.end()) {
      device = devices.insert(device, {rank_of(raw->protocol), {}});
      device->options.name = raw->stream;
      device->options.select = {{"stream", raw->stream}};
    }
    std::vector<StreamFile>& streams = device->options.files;
    std::string node = node_name(*raw);
    const auto same = [&](const StreamFile& file) { return file.node == node; };
    if (std::any_of(streams.begin(), streams.end(), same)) continue;
    streams.push_back({path, std::move(node)});
  }
  if (devices.empty()) {
    return Failure(Error{path, 0, "a recording of devices", "one in which none was heard"});
  }
  std::stable_sort(devices.begin(), devices.end(),
                   [](const Device& a, const Device& b) { return a.rank < b.rank; });
  Manifest manifest;
  manifest.subject = survey.facts->subject;
  manifest.action = survey.facts->action;
  for (Device& device : devices) {
    const bool follows = !manifest.streams.empty() && devices.front().rank <= kinect_rank;
    if (follows && device.rank == kinect_rank) manifest.spaces[device.options.name].method = "fit";
    manifest.streams.push_back(std::move(device.options));
  }
  return manifest;
}

}  // namespace kinalign
