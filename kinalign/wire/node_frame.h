// SPDX-License-Identifier: Apache-2.0
// The frame that a node with a counter sends to the host. It contains the node's counter, the
// samples since the previous frame, and the echo of the newest reply. Layout:
// docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/node_sample.h"
#include "kinalign/wire/time.h"

namespace kinalign {

inline constexpr std::size_t max_node_samples = 30;

/// The highest accepted counter, us: 31 years. A higher counter is damaged. The limit also keeps
/// sums of stamps within 64 bits of nanoseconds.
inline constexpr std::uint64_t max_counter_us = 1'000'000'000'000'000;

constexpr NodeTime node_time(std::int64_t us) { return NodeTime{std::chrono::microseconds(us)}; }

/// Names the newest reply that the node has received.
struct ReplyEcho {
  std::uint32_t reply_sequence = 0;
  std::uint32_t nonce = 0;
  std::uint64_t n_rx_us = 0;  // the node's counter when the reply arrived

  bool operator==(const ReplyEcho&) const = default;
};

/// A NodeFrame takes about 1.5 KiB. n_rx_us and the ages stand as sent: the receiver must check
/// that they are possible.
struct NodeFrame {
  DatagramOrigin origin;
  std::uint64_t n_tx_us = 0;  // the node's counter just before sending
  bool has_battery = false;
  std::uint16_t battery_mv = 0;
  bool has_echo = false;
  ReplyEcho echo;
  std::size_t sample_count = 0;
  std::array<NodeSample, max_node_samples> samples{};  // oldest first

  bool operator==(const NodeFrame&) const = default;
};

/// Writes the datagram to the front of `out`. The result is empty if `out` is too small, or if
/// there are too many samples.
[[nodiscard]] std::span<const std::uint8_t> encode(const NodeFrame& frame, const MacKey* key,
                                                   std::span<std::uint8_t> out);

/// If decoding is refused, `frame` is default-constructed.
NodeRefusal decode(const Envelope& envelope, const MacKey* key, NodeFrame& frame);

}  // namespace kinalign
