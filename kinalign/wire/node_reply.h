// SPDX-License-Identifier: Apache-2.0
// The reply that the host sends to a node for each frame. Layout: docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/node_datagram.h"

namespace kinalign {

struct NodeReply {
  DatagramOrigin origin;  // the origin of the frame
  bool locked = false;    // true if the host knows this node's clock within a certified interval
  std::uint32_t reply_sequence = 0;
  std::uint32_t nonce = 0;
  // The host's raw monotonic clock at sending, for display only. The host computes with its own
  // record.
  std::uint64_t h_tx_ns = 0;

  bool operator==(const NodeReply&) const = default;
};

/// Writes the datagram to the front of `out`. The result is empty if `out` is too small. A reply is
/// never longer than a frame with the same key.
[[nodiscard]] std::span<const std::uint8_t> encode(const NodeReply& reply, const MacKey* key,
                                                   std::span<std::uint8_t> out);

/// If decoding is refused, `reply` is default-constructed.
NodeRefusal decode(const Envelope& envelope, const MacKey* key, NodeReply& reply);

}  // namespace kinalign
