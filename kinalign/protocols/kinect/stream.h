// SPDX-License-Identifier: Apache-2.0
// Finds a Kinect's messages in datagrams and connections: docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/protocols/kinect/message.h"

#include <span>

namespace kinalign {

/// Refused messages are counted by reason. They get no answer.
struct KinectStreamCounts {
  std::uint64_t messages = 0;
  std::array<std::uint64_t, kinect_refusals> refused{};  // indexed by KinectRefusal
  std::uint64_t skipped_bytes = 0;                       // bytes that belonged to no message

  bool operator==(const KinectStreamCounts&) const = default;
};

/// Decodes one whole datagram in either encoding. After a refusal `message` is empty.
KinectRefusal decode_kinect_datagram(std::span<const std::uint8_t> datagram,
                                     KinectMessage& message);

/// Decodes a connection, fed in pieces; the result does not depend on the cuts. Keeps at most one
/// incomplete message. Looks at each byte only a few times, whatever arrives.
class KinectStreamDecoder {
 public:
  /// Appends the messages that the piece completes.
  void feed(std::span<const std::uint8_t> piece, std::vector<KinectMessage>& out);
  /// Call at the end of the connection. The rest of an incomplete message counts as too_short. A
  /// last line without its end is decoded.
  void finish(std::vector<KinectMessage>& out);

  const KinectStreamCounts& counts() const { return counts_; }
  /// True if the sender uses lines; pongs should then be lines too.
  bool speaks_lines() const { return mode_ == Mode::lines; }

 private:
  /// A connection has one encoding. The first message decides it, and it never changes.
  enum class Mode : std::uint8_t { unknown, lines, binary };

  std::size_t step(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t step_binary(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t step_line(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t skip_to_start(std::span<const std::uint8_t> bytes);
  void take(KinectRefusal refusal, KinectMessage& message, std::vector<KinectMessage>& out);

  Mode mode_ = Mode::unknown;
  std::vector<std::uint8_t> held_;
  std::size_t searched_ = 0;   // bytes of held_ that hold no line end
  bool lost_ = false;          // within bytes of no message, which are counted already
  std::uint8_t skipped_ = 0;   // the last byte that was skipped
  bool in_long_line_ = false;  // within a line that is too long, up to its end
  KinectStreamCounts counts_;
};

}  // namespace kinalign
