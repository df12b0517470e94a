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

/// The options of a listener besides its device.
struct ListenVariant {
  bool trackers = false;
  std::optional<std::uint64_t> body;

  auto operator<=>(const ListenVariant&) const = default;
};

/// Passes the messages of one device's channels to a listener. The protocol is known with the first
/// channel of payloads only. Exchanges may come before it and are kept until then, at most
/// `most_early`.
class Listening {
 public:
  explicit Listening(ListenVariant variant) : variant_(variant) {}

  /// Channels must be defined before their messages are taken.
  void define(std::uint16_t id, const RawChannel& raw) {
    channels_.push_back(id);
    if (!chosen_ && raw.protocol != exchange_encoding) chosen_ = raw;
  }
  void take(const RecordedMessage& message) {
    if (!chosen_) {  // exchanges before the first payload are kept
      if (early_.size() < most_early) early_.push_back({message, std::string(message.payload)});
      return;
    }
    if (!begin()) return;
    // The early exchanges come first, in their order.
    for (Early& early : early_) {
      early.message.payload = early.payload;
      listener_->take(early.message);
    }
    early_.clear();
    listener_->take(message);
  }

  // in the order of definition
  const std::vector<std::uint16_t>& channels() const { return channels_; }
  /// The first channel of payloads of the device.
  const std::optional<RawChannel>& chosen() const { return chosen_; }
  /// Call once, after the last message. nullptr: no rows can be made of the protocol.
  std::unique_ptr<DeviceListener> release() { return begin() ? std::move(listener_) : nullptr; }
  bool is_released() const { return begun_ && !listener_; }

 private:
  // Makes the listener when the protocol is known. It is made once, even if the protocol has none.
  bool begin() {
    if (begun_) return listener_ != nullptr;
    begun_ = true;
    const auto protocol = rows_of(chosen_->protocol, variant_.trackers);
    if (protocol) listener_ = protocol->listen(variant_.body);
    return listener_ != nullptr;
  }

  static constexpr std::size_t most_early = 1000;
  struct Early {
    RecordedMessage message;
    std::string payload;
  };
  ListenVariant variant_;
  std::vector<std::uint16_t> channels_;
  std::optional<RawChannel> chosen_;
  std::vector<Early> early_;
  bool begun_ = false;
  std::unique_ptr<DeviceListener> listener_;
};

/// A device, identified by its stream and node id or, without a node id, by its sender's host.
using DeviceKey = std::tuple<std::string, std::string, std::string, ListenVariant>;

/// One channel of the recording, with the listeners that take its messages.
struct DeviceChannel {
  RawChannel raw;
  std::uint16_t id = 0;
  std::optional<std::size_t> sender{};  // number in the stream's SenderTable
  std::uint64_t missing = 0;            // messages missing between others
  std::vector<Listening*> listening{};
};

/// The result of the first pass. Later passes need nothing else of the files: chunks are found by
/// the index, and clocks are learnt by the listeners. Pointers into `channels` and `listening` stay
/// valid, because maps do not move their elements.
struct ScannedRecording {
  FileSystem* files = nullptr;
  std::string path;
  RecordingParts parts;
  std::vector<InputFacts> input_facts;  // by part
  RecordingSurvey survey;
  SharedFile shared;
  std::shared_ptr<const StoredChunks> chunks;
  std::optional<RecordingFacts> facts;
  std::map<std::uint16_t, DeviceChannel> channels;
  std::vector<const DeviceChannel*> in_order;      // in the order of definition
  std::map<std::string, SenderTable> senders;      // by stream; nodes are not included
  std::map<std::string, std::string> attachments;  // BVH headers, by name
  std::map<DeviceKey, Listening> listening;
  std::vector<JsonChannel> json;

  Duration utc_minus_host() const {
    if (!facts) return {};
    return facts->anchor.utc.time_since_epoch() - facts->anchor.raw.time_since_epoch();
  }
};

/// Selects the streams to listen to. Without any, the recording is only surveyed.
struct ListenTo {
  bool any = false;
  std::vector<StreamOptions> wanted{};  // paths can be opened as they are; empty: all streams
};

/// Reads all parts of the recording to which the file belongs.
Result<ScannedRecording> scan_recording(FileSystem& files, const std::string& path,
                                        const ListenTo& listen, const Progress& progress);

}  // namespace kinalign
