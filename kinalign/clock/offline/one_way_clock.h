// SPDX-License-Identifier: Apache-2.0
// The clock of a device that gets no replies. Each arrival bounds its offset from above, none from
// below. The earliest arrivals show the rate. The delay of the fastest packet is unknown, so stamps
// are late by that delay and are not certified.
#pragma once

#include "kinalign/clock/host_from_node.h"

#include <span>

namespace kinalign {

/// Pieces in the order of arrival: one for each boot, and for each stretch of it in which device
/// and host counted alike. A new piece begins if the device pauses or leaps by more than 50 ms for
/// longer than three seconds. In the knots `least` and `greatest` equal the likeliest offset.
/// Echoes are not used. `curvature`, 1/s: greatest change of the offset's rate in a second.
HostFromNode fit_one_way_clock(std::span<const Exchange> exchanges, double curvature = 1e-8);

}  // namespace kinalign
