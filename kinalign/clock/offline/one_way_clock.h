// SPDX-License-Identifier: Apache-2.0
// The clock of a device that nothing answers: each arrival bounds its offset from above, nothing
// from below. The earliest arrivals tell its rate; what even the fastest packet took on its way
// can't be told from here, so that stamps are late by that, and none is certified.
#pragma once

#include "kinalign/clock/host_from_node.h"

#include <span>

namespace kinalign {

/// Pieces in the order of arrival, one for each life and for each stretch of it over which device
/// and host counted alike: a device that pauses, or leaps, by more than 50 ms for longer than
/// three seconds begins another. Of knots `least` and `greatest` are the likeliest too. Echoes are
/// not used. `curvature`, 1/s: how much the offset's rate may change in a second.
HostFromNode fit_one_way_clock(std::span<const Exchange> exchanges, double curvature = 1e-8);

}  // namespace kinalign
