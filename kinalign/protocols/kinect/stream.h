// SPDX-License-Identifier: Apache-2.0
// Finds the messages of a Kinect's sender in datagrams and connections:
// docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/protocols/kinect/message.h"

#include <span>

namespace kinalign {

/// Counts of messages, and of refused messages by reason. A refused message gets no answer.
struct KinectStreamCounts {
  std::uint64_t messages = 0;
  std::array<std::uint64_t, kinect_refusals> refused{};  // indexed by KinectRefusal
  std::uint64_t skipped_bytes = 0;                       // bytes outside of messages

  bool operator==(const KinectStreamCounts&) const = default;
};

/// Decodes one whole datagram in either encoding. If it is refused, `message` is empty.
KinectRefusal decode_kinect_datagram(std::span<const std::uint8_t> datagram,
                                     KinectMessage& message);

/// Decodes the bytes of a connection, which arrive in pieces. The result does not depend on the
/// places of the cuts. The decoder keeps at most one incomplete message, and looks at each byte
/// only a few times.
class KinectStreamDecoder {
 public:
  /// Appends the messages that the piece completes.
  void feed(std::span<const std::uint8_t> piece, std::vector<KinectMessage>& out);
  /// Call this at the end of the connection. An incomplete message counts as too_short. A last line
  /// without a line end is decoded.
  void finish(std::vector<KinectMessage>& out);

  const KinectStreamCounts& counts() const { return counts_; }
  /// True if the sender uses lines. Pongs should then be lines, too.
  bool speaks_lines() const { return mode_ == Mode::lines; }

 private:
  /// A connection has one encoding. The first message decides which, and the encoding never
  /// changes.
  enum class Mode : std::uint8_t { unknown, lines, binary };

  std::size_t step(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t step_binary(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t step_line(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t skip_to_start(std::span<const std::uint8_t> bytes);
  void take(KinectRefusal refusal, KinectMessage& message, std::vector<KinectMessage>& out);

  Mode mode_ = Mode::unknown;
  std::vector<std::uint8_t> held_;
  std::size_t searched_ = 0;   // bytes of held_ that contain no line end
  bool lost_ = false;          // within skipped bytes, which are counted already
  std::uint8_t skipped_ = 0;   // the last byte that was skipped
  bool in_long_line_ = false;  // within a line that is too long, until its end
  KinectStreamCounts counts_;
};

}  // namespace kinalign
