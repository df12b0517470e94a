// SPDX-License-Identifier: Apache-2.0
// The reply that the host sends to a node for its frame. Layout: docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/node_datagram.h"

namespace kinalign {

struct NodeReply {
  DatagramOrigin origin;  // that of the frame
  bool locked = false;    // the host has a certified interval for this node's clock
  std::uint32_t reply_sequence = 0;
  std::uint32_t nonce = 0;
  // the host's raw monotonic clock, for display; the host uses its own record
  std::uint64_t h_tx_ns = 0;

  bool operator==(const NodeReply&) const = default;
};

/// Writes the datagram to the front of `out`. Empty if there is not enough space. It is never
/// longer than a frame with the same key.
[[nodiscard]] std::span<const std::uint8_t> encode(const NodeReply& reply, const MacKey* key,
                                                   std::span<std::uint8_t> out);

/// After a refusal `reply` is default-constructed.
NodeRefusal decode(const Envelope& envelope, const MacKey* key, NodeReply& reply);

}  // namespace kinalign
