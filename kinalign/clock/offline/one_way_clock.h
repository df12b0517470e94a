// SPDX-License-Identifier: Apache-2.0
// The clock of a device that gets no replies. Each arrival gives an upper bound of its offset;
// there are no lower bounds. The earliest arrivals show the rate. The least delay is unknown, so
// stamps are late by that delay and are not certified.
#pragma once

#include "kinalign/clock/host_from_node.h"

#include <span>

namespace kinalign {

/// Returns pieces in the order of arrival. Each boot begins a piece. A new piece also begins if the
/// device's clock jumps by more than 50 ms against the host's for longer than three seconds. In the
/// knots, `least` and `greatest` equal the likeliest offset. Echoes are not used. `curvature`, 1/s:
/// greatest change of the offset's rate in a second.
HostFromNode fit_one_way_clock(std::span<const Exchange> exchanges, double curvature = 1e-8);

}  // namespace kinalign
