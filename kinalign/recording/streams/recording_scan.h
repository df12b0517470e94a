// SPDX-License-Identifier: Apache-2.0
// The first pass over a recording: it indexes the chunks, hashes and surveys the files, and listens
// to the devices.
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

/// What a listener is made for beside its device.
struct ListenVariant {
  bool trackers = false;
  std::optional<std::uint64_t> body;

  auto operator<=>(const ListenVariant&) const = default;
};

/// Listens to the channels of one device.
class Listening {
 public:
  explicit Listening(ListenVariant variant) : variant_(variant) {}

  /// Channels are defined before their messages come.
  void define(std::uint16_t id, const RawChannel& raw) {
    channels_.push_back(id);
    if (!chosen_ && raw.protocol != exchange_encoding) chosen_ = raw;
  }
  void take(const RecordedMessage& message) {
    if (!chosen_) {  // exchanges before the first payload
      if (early_.size() < most_early) early_.push_back({message, std::string(message.payload)});
      return;
    }
    if (!begin()) return;
    for (Early& early : early_) {
      early.message.payload = early.payload;
      listener_->take(early.message);
    }
    early_.clear();
    listener_->take(message);
  }

  const std::vector<std::uint16_t>& channels() const { return channels_; }  // as defined
  /// The device's first channel of payloads.
  const std::optional<RawChannel>& chosen() const { return chosen_; }
  /// After the last message, once. nullptr: no rows can be made of the protocol.
  std::unique_ptr<DeviceListener> release() { return begin() ? std::move(listener_) : nullptr; }
  bool is_released() const { return begun_ && !listener_; }

 private:
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

/// A device by its stream and node id or, without one, by its sender's host.
using DeviceKey = std::tuple<std::string, std::string, std::string, ListenVariant>;

struct DeviceChannel {
  RawChannel raw;
  std::uint16_t id = 0;
  std::optional<std::size_t> sender{};  // its number on the stream's roll
  std::optional<std::uint32_t> last_number{};
  std::uint64_t missing = 0;  // messages between others
  std::vector<Listening*> listening{};
};

/// What the first pass has found.
struct ScannedRecording {
  FileSystem* files = nullptr;
  std::string path;
  RecordingParts parts;
  std::vector<InputFacts> input_facts;
  std::vector<RecordingSurvey> surveys;  // by part
  SharedFile shared;
  std::shared_ptr<const StoredChunks> chunks;
  std::optional<RecordingFacts> facts;
  std::map<std::uint16_t, DeviceChannel> channels;
  std::vector<const DeviceChannel*> in_order;      // as they were defined
  std::map<std::string, SenderRoll> senders;       // by stream, without its nodes
  std::map<std::string, std::string> attachments;  // BVH headers, by name
  std::map<DeviceKey, Listening> listening;
  std::vector<JsonChannel> json;

  Duration utc_minus_host() const {
    if (!facts) return {};
    return facts->anchor.utc.time_since_epoch() - facts->anchor.raw.time_since_epoch();
  }
};

/// Which streams are listened to.
struct ListenTo {
  bool any = false;
  std::vector<StreamOptions> wanted{};  // with paths as they can be opened; empty: all streams
};

/// Reads the file and, as they lie in the same folder, those that its recording went on in.
Result<ScannedRecording> scan_recording(FileSystem& files, const std::string& path,
                                        const ListenTo& listen, const Progress& progress);

}  // namespace kinalign
