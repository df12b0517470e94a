// SPDX-License-Identifier: Apache-2.0
// A reply, what the host sends to a node for its frame. Layout: docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/node_datagram.h"

namespace kinalign {

struct NodeReply {
  DatagramOrigin origin;  // of the frame
  bool locked = false;    // the host has an interval for this node's clock
  std::uint32_t reply_sequence = 0;
  std::uint32_t nonce = 0;
  std::uint64_t h_tx_ns = 0;  // the host's raw monotonic clock, to be shown: the host keeps its own

  bool operator==(const NodeReply&) const = default;
};

/// Never more than any frame with the same key.
std::size_t encoded_size(const NodeReply& reply, const MacKey* key);

/// The datagram, at the front of `out`; empty where it has no room.
[[nodiscard]] std::span<const std::uint8_t> encode(const NodeReply& reply, const MacKey* key,
                                                   std::span<std::uint8_t> out);

/// After a refusal `reply` is as new.
NodeRefusal decode(const Envelope& envelope, const MacKey* key, NodeReply& reply);

}  // namespace kinalign
