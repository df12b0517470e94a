// SPDX-License-Identifier: Apache-2.0
// The clock of a device that sends pings. The estimate made during recording is only displayed. The
// clock of a take is fitted after the recording, to all exchanges (clock/offline/device_clock.h).
#pragma once

#include "kinalign/capture/net/sender_clock.h"
#include "kinalign/clock/live/live_clock.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace kinalign {

/// Returns the clock at the stamp for display. `n` is the reading of the sender's clock at that
/// stamp.
SenderClock sender_clock(const ClockStamp& stamp, NodeTime n, double drift);

class FollowedClock {
 public:
  /// Adds one exchange. `epoch` is the epoch of the host's time axis (HostAxis::epoch).
  void push(Exchange exchange, std::uint32_t epoch);
  /// The clock at the newest exchange. Absent while there are too few exchanges.
  const std::optional<SenderClock>& now() const { return now_; }

 private:
  std::unique_ptr<LiveClock> clock_ = std::make_unique<LiveClock>();
  HostTime newest_arrival_ = HostTime::min();
  std::optional<SenderClock> now_;
};

}  // namespace kinalign
