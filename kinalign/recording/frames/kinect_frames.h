// SPDX-License-Identifier: Apache-2.0
// Frames of a Kinect out of a recording, with their bodies together.
#pragma once

#include "kinalign/protocols/kinect/frames.h"
#include "kinalign/protocols/kinect/stream.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/recording/format.h"
#include "kinalign/wire/little_endian_reader.h"

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace kinalign {

/// One sensor's, in the order of arrival.
class KinectFrames {
 public:
  /// Appends what the message completes. Parts as they came go to `heard`.
  void take(const RecordedMessage& message, std::vector<JoinedKinectFrame>& out,
            std::vector<KinectFrame>* heard) {
    messages_.clear();
    KinectStreamDecoder& decoder = decoders_[message.channel_id];
    decoder.feed(octets(message.payload), messages_);
    if (is_datagrams(message.channel->transport)) decoder.finish(messages_);  // it has one message
    for (KinectMessage& one : messages_) {
      auto* frame = std::get_if<KinectFrame>(&one);
      if (frame == nullptr) continue;
      if (!sensor_) sensor_ = frame->origin.sensor;
      if (frame->origin.sensor != *sensor_) {
        ++of_other_sensors;
        continue;
      }
      if (heard != nullptr) heard->push_back(*frame);
      joiner_.take(std::move(*frame), out, message.channel->sender);
    }
  }
  void finish(std::vector<JoinedKinectFrame>& out) { joiner_.finish(out); }
  KinectFrameCounts counts() const { return joiner_.counts(); }
  const std::optional<KinectTwins>& twins() const { return joiner_.twins(); }

  std::uint64_t of_other_sensors = 0;

 private:
  std::map<std::uint16_t, KinectStreamDecoder> decoders_;  // by channel: a sender or a connection
  std::vector<KinectMessage> messages_;
  std::optional<std::uint32_t> sensor_;
  KinectFrameJoiner joiner_;
};

}  // namespace kinalign
