// SPDX-License-Identifier: Apache-2.0
// The clock of one node over a whole recording: what the live clock found, told again with all that
// came later.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/clock/live/live_clock.h"

#include <span>
#include <vector>

namespace kinalign {

struct OfflineClock {
  HostFromNode model;
  std::vector<ClockEvent> events;  // as the live clock has them, withdrawn stretches aside
};

/// Exchanges in the order of arrival.
OfflineClock fit_offline_clock(std::span<const Exchange> exchanges,
                               const Assumptions& assumptions = {});

}  // namespace kinalign
