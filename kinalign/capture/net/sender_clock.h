// SPDX-License-Identifier: Apache-2.0
// The clock of a device that sends pings, for display.
#pragma once

#include "kinalign/wire/time.h"

#include <optional>

namespace kinalign {

struct SenderClock {
  Duration host_minus_sender{};
  std::optional<Duration> half_interval;  // absent: the interval is not certified
  double drift = 0.0;  // estimated rate of the host's clock against the sender's, minus 1
};

}  // namespace kinalign
