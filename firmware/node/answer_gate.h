// SPDX-License-Identifier: Apache-2.0
// Decides which of the host's datagrams a node accepts, and gives the numbers of the node's own
// frames, which those datagrams must name.
#pragma once

#include "kinalign/wire/node_datagram.h"

#include <array>

namespace kinalign {

/// The answers that were accepted, and those that were ignored, by cause.
struct AnswerCounts {
  std::uint64_t accepted = 0;
  std::array<std::uint64_t, node_refusals> refused{};  // by NodeRefusal: the bytes were wrong
  std::uint64_t other_node = 0;
  std::uint64_t other_boot = 0;     // for an earlier start of this node, or forged
  std::uint64_t unknown_frame = 0;  // the answer is for none of the last frames
  /// This frame or a later one was answered already: the answer is a replay, or late.
  std::uint64_t not_newer = 0;
};

/// Each frame (for a node without a counter: each request) is answered once, and the newest answer
/// counts. An answer is newer if it answers a newer frame, not if it has a higher reply sequence.
/// The reply sequence starts anew with the host, and a node that compared it would ignore the new
/// host. A frame's number never comes again.
class AnswerGate {
 public:
  static constexpr std::uint32_t window = 64;  // frames: 4 s at 15/s; a later answer is of no use

  explicit AnswerGate(const DatagramOrigin& first) : next_(first) {}

  /// The number of the next frame. Each number is given once, even if its frame is not sent.
  DatagramOrigin issue();
  /// Whether the answer to the frame `answered` is accepted. The counts are updated either way.
  bool admit(const DatagramOrigin& answered);
  /// Counts an answer that was refused for its bytes.
  void refuse(NodeRefusal why) { ++counts_.refused[static_cast<std::size_t>(why)]; }
  const AnswerCounts& counts() const { return counts_; }

 private:
  static bool ignore(std::uint64_t& cause) {
    ++cause;
    return false;
  }

  DatagramOrigin next_;
  std::uint32_t sent_ = 0;  // the number of last frames that may be answered, up to `window`
  std::uint32_t open_ = 0;  // the newest of these, for which no answer came yet
  AnswerCounts counts_;
};

}  // namespace kinalign
