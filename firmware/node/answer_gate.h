// SPDX-License-Identifier: Apache-2.0
// Which of the host's datagrams a node listens to, and the numbers of its own that they have to
// name.
#pragma once

#include "kinalign/wire/node_datagram.h"

#include <array>

namespace kinalign {

/// What was ignored, a number a cause.
struct AnswerCounts {
  std::uint64_t accepted = 0;
  std::array<std::uint64_t, node_refusals> refused{};  // by NodeRefusal: the bytes were wrong
  std::uint64_t other_node = 0;
  std::uint64_t other_boot = 0;     // of an earlier start of this node, or made up
  std::uint64_t unknown_frame = 0;  // answers none of the last ones that were sent
  std::uint64_t not_newer = 0;  // that frame or a later one has been answered: a replay, or late
};

/// Each frame (of a node without a counter: request) is answered once, the newest answer counts.
/// Newer is what answers a newer frame, not what has a higher reply sequence: that one starts anew
/// with the host, and a node would be deaf to the new one. A frame's number never comes again.
class AnswerGate {
 public:
  static constexpr std::uint32_t window = 64;  // frames: 4 s at 15/s; later than that helps nobody

  explicit AnswerGate(const DatagramOrigin& first) : next_(first) {}

  /// The number of the next frame; it is given once, whether or not that frame gets away.
  DatagramOrigin issue();
  /// Whether what answers `answered` counts; counted either way.
  bool admit(const DatagramOrigin& answered);
  /// Counts what was refused before.
  void refuse(NodeRefusal why) { ++counts_.refused[static_cast<std::size_t>(why)]; }
  const AnswerCounts& counts() const { return counts_; }

 private:
  static bool ignore(std::uint64_t& cause) {
    ++cause;
    return false;
  }

  DatagramOrigin next_;
  std::uint32_t sent_ = 0;  // of the last frames: up to `window`
  std::uint32_t open_ = 0;  // of these, the newest ones, which no answer has reached
  AnswerCounts counts_;
};

}  // namespace kinalign
