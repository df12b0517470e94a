// SPDX-License-Identifier: Apache-2.0
// Frames of inertial nodes out of a recording: those that the recorder accepted, with what it found
// out about their clock.
#pragma once

#include "kinalign/recording/format.h"
#include "kinalign/wire/node_frame.h"

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

namespace kinalign {

/// The number of a request, since its node started.
inline std::int64_t number_of(const ClocklessExchange& e) {
  return static_cast<std::int64_t>(e.frame) - (std::int64_t{1} << 32);
}

/// What brought samples and was accepted when it came.
struct AcceptedFrame {
  BootKey life = 0;
  std::optional<NodeTime> n_tx;  // absent: the node has no counter, its requests have numbers
  std::int64_t number = 0;
  std::array<NodeSample, max_node_samples> samples{};
  std::size_t sample_count = 0;
};

using AnyExchange = std::variant<std::monostate, Exchange, ClocklessExchange>;

/// What was held, came twice or came late is in the recording, too; of an accepted datagram the
/// exchange stands before it, with the same counter or number, and arrival.
class AcceptedFrames {
 public:
  /// The exchange, if it is one; its boot is the life's key.
  AnyExchange take_exchange(const RecordedMessage& message);
  /// The frame, if the exchange before it says that it was accepted.
  std::optional<AcceptedFrame> take(const RecordedMessage& message);

  std::uint64_t others = 0;

 private:
  struct Accepted {
    BootKey life = 0;
    std::optional<NodeTime> n_tx;
    std::int64_t number = 0;
    bool confirms = false;
    HostTime at;
  };
  std::optional<Accepted> accepted_;
};

}  // namespace kinalign
