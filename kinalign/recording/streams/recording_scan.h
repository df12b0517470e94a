// SPDX-License-Identifier: Apache-2.0
// The first pass over a recording. It indexes the chunks, hashes and surveys all parts, and learns
// the devices' clocks.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/senders.h"
#include "kinalign/recording/streams/stored_chunks.h"
#include "kinalign/recording/survey.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace kinalign {

/// The options of a listener, in addition to its device.
struct ListenVariant {
  bool trackers = false;
  std::optional<std::uint64_t> body;

  auto operator<=>(const ListenVariant&) const = default;
};

/// The listener of one device, and the channels that it takes.
struct Listening {
  std::unique_ptr<DeviceListener> listener;  // nullptr if the protocol gives no rows
  std::vector<std::uint16_t> channels{};     // in the order of definition
};

/// Identifies a device by stream, node id (if any), sender's host (if there is no node id),
/// protocol and options.
using DeviceKey =
    std::tuple<std::string, std::string, std::string, std::optional<Protocol>, ListenVariant>;
inline DeviceKey key_of(const RawChannel& raw, const ListenVariant& variant) {
  return {raw.stream, raw.node, raw.node.empty() ? host_of(raw.sender) : "", protocol_of(raw),
          variant};
}

/// One channel of the recording, with the listeners that take its messages.
struct DeviceChannel {
  RawChannel raw;
  std::uint16_t id = 0;
  std::optional<std::size_t> sender{};  // index in the stream's SenderTable
  std::uint64_t missing = 0;            // numbers missing between the channel's messages
  std::vector<Listening*> listening{};
};

/// A channel of the recorder itself with JSON messages: marks, counts, or the host's clocks.
struct JsonChannel {
  std::uint16_t id = 0;
  std::string topic;
  McapSchema schema;
};

/// The result of the first pass. Later passes need nothing else: the index gives the positions of
/// chunks, and the listeners know the clocks. Pointers into `channels` and `listening` stay valid,
/// because maps do not move their elements.
struct ScannedRecording {
  FileSystem* files = nullptr;
  std::string path;
  RecordingParts parts;
  std::vector<InputFacts> input_facts;  // one for each part
  RecordingSurvey survey;
  SharedFile shared;
  std::shared_ptr<const StoredChunks> chunks;
  std::map<std::uint16_t, DeviceChannel> channels;
  std::vector<const DeviceChannel*> in_order;      // channels in the order of definition
  std::map<std::string, SenderTable> senders;      // by stream; inertial nodes are not included
  std::map<std::string, std::string> attachments;  // BVH heads by name
  std::map<DeviceKey, Listening> listening;
  std::vector<JsonChannel> json;
};

/// Reads all parts of the recording to which the file belongs. `wanted`: the streams whose devices
/// get a listener. Their paths must be ready to be opened. An empty list means all streams. nullptr
/// means that the recording is only surveyed.
Result<ScannedRecording> scan_recording(FileSystem& files, const std::string& path,
                                        const std::vector<StreamOptions>* wanted,
                                        const Progress& progress);

}  // namespace kinalign
