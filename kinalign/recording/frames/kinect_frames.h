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

/// The frames of one sensor, in the order of arrival. Over TCP a message may be cut anywhere, so
/// each channel has a decoder that keeps the incomplete message.
class KinectFrames {
 public:
  /// Appends to `out` the frames that the message completes. Appends to `parts` each part of a
  /// frame.
  void take(const RecordedMessage& message, std::vector<JoinedKinectFrame>& out,
            std::vector<KinectFrame>* parts) {
    messages_.clear();
    KinectStreamDecoder& decoder = decoders_[message.channel_id];
    decoder.feed(octets(message.payload), messages_);
    // A datagram contains whole messages, so the decoder must not wait for more bytes.
    if (is_datagrams(message.channel->transport)) decoder.finish(messages_);
    for (KinectMessage& one : messages_) {
      auto* frame = std::get_if<KinectFrame>(&one);
      if (frame == nullptr) continue;
      // The first frame selects the sensor. Frames of another sensor on the same port are not mixed
      // in.
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

  /// The number of frames of other sensors, which were left out.
  std::uint64_t of_other_sensors = 0;

 private:
  // One decoder for each channel, which is a sender or a connection.
  std::map<std::uint16_t, KinectStreamDecoder> decoders_;
  std::vector<KinectMessage> messages_;
  std::optional<std::uint32_t> sensor_;
  KinectFrameJoiner joiner_;
};

}  // namespace kinalign
