// SPDX-License-Identifier: Apache-2.0
// Reads the frames of a Kinect from a recording and joins the bodies of each frame.
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

/// The frames of one sensor, in the order of arrival. A sender over TCP may cut a message anywhere,
/// so each channel has a decoder that keeps the incomplete rest.
class KinectFrames {
 public:
  /// Appends the frames that the message completes. The single parts are appended to `parts`.
  void take(const RecordedMessage& message, std::vector<JoinedKinectFrame>& out,
            std::vector<KinectFrame>* parts) {
    messages_.clear();
    KinectStreamDecoder& decoder = decoders_[message.channel_id];
    decoder.feed(octets(message.payload), messages_);
    // a datagram contains whole messages
    if (is_datagrams(message.channel->transport)) decoder.finish(messages_);
    for (KinectMessage& one : messages_) {
      auto* frame = std::get_if<KinectFrame>(&one);
      if (frame == nullptr) continue;
      // The first frame decides, so a second sensor on the same port does not mix with it.
      if (!sensor_) sensor_ = frame->origin.sensor;
      if (frame->origin.sensor != *sensor_) {
        ++of_other_sensors;
        continue;
      }
      if (parts != nullptr) parts->push_back(*frame);
      joiner_.take(std::move(*frame), out, message.channel->sender);
    }
  }
  void finish(std::vector<JoinedKinectFrame>& out) { joiner_.finish(out); }
  KinectFrameCounts counts() const { return joiner_.counts(); }
  const std::optional<KinectOverlap>& overlap() const { return joiner_.overlap(); }

  /// Frames of other sensors, which were left out. The first frame selects the sensor.
  std::uint64_t of_other_sensors = 0;

 private:
  // by channel: one sender or connection each
  std::map<std::uint16_t, KinectStreamDecoder> decoders_;
  std::vector<KinectMessage> messages_;
  std::optional<std::uint32_t> sensor_;
  KinectFrameJoiner joiner_;
};

}  // namespace kinalign
