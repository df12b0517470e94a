// SPDX-License-Identifier: Apache-2.0
// The clock of a sender that pings, as the screen shows it.
#pragma once

#include "kinalign/wire/time.h"

#include <optional>

namespace kinalign {

struct SenderClock {
  Duration host_minus_sender{};
  std::optional<Duration> half_interval;  // certified; absent: not (yet)
  double drift = 0.0;                     // of the host's rate against the sender's, as estimated
};

}  // namespace kinalign
