// SPDX-License-Identifier: Apache-2.0
// Reads the frames of inertial nodes from a recording: only frames that the recorder accepted, with
// the clock exchanges that it stored.
#pragma once

#include "kinalign/recording/format.h"
#include "kinalign/wire/node_frame.h"

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

namespace kinalign {

/// The number of a request, counted from the start of its node.
inline std::int64_t number_of(const ClocklessExchange& e) {
  return static_cast<std::int64_t>(e.frame) - (std::int64_t{1} << 32);
}

/// A datagram with samples that the recorder accepted.
struct AcceptedFrame {
  BootKey boot = 0;
  std::optional<NodeTime> n_tx;  // empty: the node has no counter, but numbers its requests
  std::int64_t number = 0;
  std::array<NodeSample, max_node_samples> samples{};
  std::size_t sample_count = 0;
};

/// The exchange of a node with a counter, or of a node without; std::monostate for other messages.
using AnyExchange = std::variant<std::monostate, Exchange, ClocklessExchange>;

/// Selects the datagrams that the recorder accepted. A recording also contains duplicate and late
/// datagrams, and datagrams of nodes that the recorder had not verified yet. The exchange of each
/// accepted datagram stands directly before it. Both have the same arrival and the same counter or
/// number.
class AcceptedFrames {
 public:
  /// Decodes an exchange. Its `boot` becomes the key of the clock model, see boot_in_epoch().
  AnyExchange take_exchange(const RecordedMessage& message);
  /// Returns the frame if the exchange before it belongs to it. Other frames were not accepted.
  std::optional<AcceptedFrame> take(const RecordedMessage& message);

  /// The number of datagrams that were not accepted, or do not fit the exchange before them.
  std::uint64_t others = 0;

 private:
  /// The last exchange. `confirms`: it belongs to a confirm, which has no sample, and not to a
  /// request.
  struct Accepted {
    BootKey boot = 0;
    std::optional<NodeTime> n_tx;
    std::int64_t number = 0;
    bool confirms = false;
    HostTime at;
  };
  std::optional<Accepted> accepted_;
};

}  // namespace kinalign
