// SPDX-License-Identifier: Apache-2.0
// What one device said, out of a recording's files: docs/formats/recording.md. Fed them in pieces,
// whole or torn.
#pragma once

#include "kinalign/mcap/reader.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/streams/sender_roll.h"
#include "kinalign/take/recording.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace kinalign {

/// Which device. An empty sender: the first that is heard; an empty node: the only one.
struct DeviceChoice {
  std::string stream;
  std::string node;    // of inertial nodes: an id, or a place where the lab named it
  std::string sender;  // the address, with its port or without
  std::set<std::string> passed_over{};  // of this address: whom not to take, with their ports

  bool operator==(const DeviceChoice&) const = default;
};

struct RecordedMessage {
  const RawChannel* channel = nullptr;
  std::uint16_t channel_id = 0;
  HostTime arrival{};
  std::string_view payload;  // good until the next message
  bool is_exchange() const { return channel->protocol == exchange_encoding; }
};
using TakeMessage = std::function<Result<void>(const RecordedMessage&)>;

class RecordedMessages {
 public:
  /// `parts`: the recording's files from this one on.
  RecordedMessages(DeviceChoice choice, std::shared_ptr<const RecordingParts> parts);

  /// Hands on the device's messages that the piece completes, in the order of arrival.
  Result<void> feed(std::string_view piece, const TakeMessage& take);
  /// The file has ended; the next pieces are of the next part.
  Result<void> next_part(const TakeMessage& take);
  /// The last file has ended. Fails where it is no recording of ours or the device is not in it.
  Result<void> finish(const TakeMessage& take);

  /// Absent until its record has been read, which stands in front of all messages.
  const std::optional<RecordingFacts>& facts() const { return facts_; }
  /// What log times are more than arrivals on the host's axis.
  Duration utc_minus_host() const;
  /// The header of the stream's skeleton, where the recording has one; in front of all messages.
  const std::string& skeleton() const { return skeleton_; }
  /// The device's first channel, once it was heard.
  const std::optional<RawChannel>& chosen() const { return chosen_; }
  /// Who else spoke in the stream; empty where it is one of nodes. Complete after finish().
  const SenderRoll& senders() const { return roll_; }
  /// That the files are torn or damaged, and the marks in them, whichever device is read; complete
  /// after finish().
  const SaidByFile& by_file() const { return by_file_; }
  /// That messages of the device are missing; complete after finish().
  const Findings& findings() const { return findings_; }

 private:
  struct Channel {
    RawChannel raw;
    bool wanted = false;
    std::optional<std::size_t> sender{};  // on the roll
    std::optional<std::uint32_t> last_number{};
  };
  Result<void> take_records(const TakeMessage& take);
  Result<void> take_one(const McapRecord& record, const TakeMessage& take);
  void take_mark(const McapMessage& message);
  Result<void> take_message(const McapMessage& message, const TakeMessage& take);
  void add(const McapChannel& defined);
  bool is_wanted(const RawChannel& raw);
  std::optional<std::size_t> place_on_roll(const RawChannel& raw);
  void judge_file();
  void judge_end();
  const std::string& file() const { return parts_->at(part_).path; }

  DeviceChoice choice_;
  bool any_node_;  // was asked for
  std::shared_ptr<const RecordingParts> parts_;
  std::size_t part_ = 0;
  McapReader reader_;
  NumberGuard guard_;
  std::optional<RecordingFacts> facts_;
  std::string skeleton_;
  std::optional<RawChannel> chosen_;
  std::map<std::uint16_t, Channel> channels_;
  std::set<std::string> streams_, nodes_, meant_;  // that are there; whom the choice's node names
  SenderRoll roll_;
  std::uint64_t missing_ = 0;
  std::set<std::uint16_t> mark_channels_;
  std::uint64_t more_marks_ = 0;  // than are looked at
  std::optional<RecordingEnd> end_;
  bool ended_ = false;  // or torn for good
  SaidByFile by_file_;
  Findings findings_;
};

}  // namespace kinalign
