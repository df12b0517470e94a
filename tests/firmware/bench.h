// SPDX-License-Identifier: Apache-2.0
// A node on a fake board, run through virtual time.
#pragma once

#include "firmware/node/node.h"
#include "tests/firmware/fake_board.h"

namespace kinalign {

inline constexpr NodeSettings settings{
    .node_id = 7, .boot_id = 0x5eedf00d, .frame_period_us = 100'000, .dither_us = 0};

/// A node with its link up, and a sample timer of 100 Hz.
struct Bench {
  explicit Bench(const NodeSettings& with = settings) : node(board, with), key_of(with) {
    node.set_link(true);
    node.poll();  // frames are due from here on, the first after half a period
  }

  /// Ticks every 10 ms, and polls every ms, for `for_us`.
  void run(std::uint64_t for_us) {
    for (const std::uint64_t end = board.now_us + for_us; board.now_us < end;) {
      const std::uint64_t ms = board.now_us / 1000;
      if (ms / 10 != ticked) node.tick(1);
      ticked = ms / 10;
      node.poll();
      board.now_us = std::max(board.now_us + 1, (ms + 1) * 1000);
    }
  }
  NodeFrame frame(std::size_t i) const {
    return decoded<NodeFrame>(board.sent.at(i), key_of.has_key ? &key_of.key : nullptr);
  }
  NodeFrame last() const { return frame(board.sent.size() - 1); }

  FakeBoard board;
  Node node;
  NodeSettings key_of;
  std::uint64_t ticked = 100;
};

}  // namespace kinalign
