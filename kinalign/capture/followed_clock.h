// SPDX-License-Identifier: Apache-2.0
// The clock of a device that pings, followed while it is recorded: for the screen. Takes get theirs
// from all exchanges, afterwards (clock/device_clock.h).
#pragma once

#include "kinalign/clock/live_clock.h"

#include <cstdint>
#include <optional>

namespace kinalign {

struct SenderClock {
  Duration host_minus_sender{};
  std::optional<Duration> half_interval;  // certified; absent: not (yet)
  double drift = 0.0;                     // of the host's rate against the sender's, as estimated
};

/// `n`: the sender's clock at that stamp.
SenderClock sender_clock(const ClockStamp& stamp, NodeTime n, double drift);

class FollowedClock {
 public:
  /// `epoch`: of the host's axis.
  void push(Exchange exchange, std::uint32_t epoch);
  /// As of the newest exchange; absent while too little is known.
  const std::optional<SenderClock>& now() const { return now_; }

 private:
  LiveClock clock_;
  HostTime heard_ = HostTime::min();
  std::optional<SenderClock> now_;
};

}  // namespace kinalign
