// SPDX-License-Identifier: Apache-2.0
// A Kinect's messages out of datagrams and connections: docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/protocols/kinect/message.h"

#include <span>

namespace kinalign {

struct KinectStreamCounts {
  std::uint64_t messages = 0;
  std::array<std::uint64_t, kinect_refusals> refused{};  // by KinectRefusal
  std::uint64_t skipped_bytes = 0;                       // that belonged to no message

  bool operator==(const KinectStreamCounts&) const = default;
};

/// One datagram, whole, in either encoding. After a refusal `message` is as new.
KinectRefusal decode_kinect_datagram(std::span<const std::uint8_t> datagram,
                                     KinectMessage& message);

/// One connection, fed in pieces cut anywhere: what comes out does not depend on the cuts. Holds at
/// most one message that is not whole yet, and looks at each byte a few times at most, whatever
/// comes.
class KinectStreamDecoder {
 public:
  /// Appends the messages that the piece completes.
  void feed(std::span<const std::uint8_t> piece, std::vector<KinectMessage>& out);
  /// The connection has ended: what is left of a message counts as too_short; a last line without
  /// its end is a line.
  void finish(std::vector<KinectMessage>& out);

  const KinectStreamCounts& counts() const { return counts_; }
  /// Lines, as pongs should be then.
  bool speaks_lines() const { return mode_ == Mode::lines; }

 private:
  enum class Mode : std::uint8_t { unknown, lines, binary };

  std::size_t step(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t step_binary(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t step_line(std::span<const std::uint8_t> bytes, std::vector<KinectMessage>& out);
  std::size_t skip_to_start(std::span<const std::uint8_t> bytes);
  void take(KinectRefusal refusal, KinectMessage& message, std::vector<KinectMessage>& out);

  Mode mode_ = Mode::unknown;
  std::vector<std::uint8_t> held_;
  std::size_t searched_ = 0;   // of what is held: no line end is there
  bool lost_ = false;          // within a stretch that is counted already
  std::uint8_t skipped_ = 0;   // the last byte that was
  bool in_long_line_ = false;  // until its end
  KinectStreamCounts counts_;
};

}  // namespace kinalign
