// SPDX-License-Identifier: Apache-2.0
// The clock of a device that pings, followed while it is recorded: for the screen. Takes get theirs
// from all exchanges, afterwards (clock/offline/device_clock.h).
#pragma once

#include "kinalign/capture/net/sender_clock.h"
#include "kinalign/clock/clock_stamp.h"
#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace kinalign {

class LiveClock;

/// `n`: the sender's clock at that stamp.
SenderClock sender_clock(const ClockStamp& stamp, NodeTime n, double drift);

class FollowedClock {
 public:
  FollowedClock();
  FollowedClock(FollowedClock&&) noexcept;
  FollowedClock& operator=(FollowedClock&&) noexcept;
  FollowedClock(const FollowedClock&) = delete;
  FollowedClock& operator=(const FollowedClock&) = delete;
  ~FollowedClock();

  /// `epoch`: of the host's axis.
  void push(Exchange exchange, std::uint32_t epoch);
  /// As of the newest exchange; absent while too little is known.
  const std::optional<SenderClock>& now() const { return now_; }

 private:
  std::unique_ptr<LiveClock> clock_;
  HostTime heard_ = HostTime::min();
  std::optional<SenderClock> now_;
};

}  // namespace kinalign
