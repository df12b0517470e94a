// SPDX-License-Identifier: Apache-2.0
// Queries this host's chronyd from time to time, without blocking.
#pragma once

#include "kinalign/capture/ntp/chrony_tracking.h"
#include "kinalign/core/handle.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// The socket stays open. If chronyd starts later, the next request reaches it.
class ChronyQuery {
 public:
  /// `port`: chronyd's cmdport on 127.0.0.1. Without a chronyd there is never an answer.
  explicit ChronyQuery(std::uint16_t port);

  /// Returns the last answer if it is at most ten seconds old. Sends a new request every two
  /// seconds.
  std::optional<ChronyTracking> latest(HostTime now);
  /// Waits up to 100 ms for the answer to the last request.
  void wait() const;

 private:
  void receive(HostTime now);

  Handle socket_;
  std::uint32_t sequence_ = 0;
  std::optional<HostTime> asked_at_, answered_at_;
  ChronyTracking answer_;
};

}  // namespace kinalign
