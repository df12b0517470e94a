// SPDX-License-Identifier: Apache-2.0
// Reads the frames of inertial nodes from a recording: those that the recorder accepted, with the
// clock exchanges that it stored.
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

/// A datagram with samples that was accepted during recording.
struct AcceptedFrame {
  BootKey boot = 0;
  std::optional<NodeTime> n_tx;  // absent: the node has no counter, but numbers its requests
  std::int64_t number = 0;
  std::array<NodeSample, max_node_samples> samples{};
  std::size_t sample_count = 0;
};

/// An exchange of a node with a counter, of one without, or (monostate) a message that is neither.
using AnyExchange = std::variant<std::monostate, Exchange, ClocklessExchange>;

/// Selects the accepted datagrams. A recording also contains held, duplicate and late datagrams.
/// Before each accepted datagram stands its exchange, with the same counter or number and the same
/// arrival.
class AcceptedFrames {
 public:
  /// Decodes an exchange. Its `boot` is the key of the clock model, see boot_in_epoch().
  AnyExchange take_exchange(const RecordedMessage& message);
  /// Returns the frame if the exchange before it says that it was accepted.
  std::optional<AcceptedFrame> take(const RecordedMessage& message);

  /// Datagrams that were not accepted, or do not fit the exchange before them.
  std::uint64_t others = 0;

 private:
  /// The exchange that was read last. `confirms`: it belongs to a confirm and not to a request with
  /// a sample.
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
