// SPDX-License-Identifier: Apache-2.0
// The clock of one node over a whole recording. It repeats the computation of the clock during
// recording (live_clock.h) with all later exchanges.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/clock/live/live_clock.h"

#include <span>
#include <vector>

namespace kinalign {

/// The live clock's withdrawals are doubtful stretches of the model.
struct OfflineClock {
  HostFromNode model;
  std::vector<ClockEvent> events;  // events of the live clock, without withdrawals
};

/// Exchanges must be in the order of arrival.
OfflineClock fit_offline_clock(std::span<const Exchange> exchanges,
                               const Assumptions& assumptions = {});

}  // namespace kinalign
