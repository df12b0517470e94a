// SPDX-License-Identifier: Apache-2.0
// Nodes without a clock, as in section 3.2 of the HFUT-MMD paper: the host stamps the arrival of a
// frame (T2), its answer (T3) and the node's confirmation of that (T6), takes d = (T6 - T3) / 2 for
// the way of a frame and T2 - d for the time at which it was sent. No certificate: d is half a
// round trip of other packets, and half of what the node dallied. docs/clock.md has what that
// costs.
#pragma once

#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

struct ClocklessExchange {
  std::uint64_t frame =
      0;  // a turn (2^32) above its number since the node's start; lost ones count
  HostTime t2{}, t3{};
  std::optional<HostTime> t6;  // absent: the answer or its confirmation was lost
  BootKey boot = 0;            // the node's life
};

/// Absent where t6 is.
std::optional<Duration> one_way_delay(const ClocklessExchange& exchange);

/// Of all; absent where no exchange was confirmed.
std::optional<Duration> least_one_way_delay(std::span<const ClocklessExchange> exchanges);

/// T2 - d with each frame's own d; absent where that is.
std::vector<std::optional<HostTime>> stamps_by_each_delay(
    std::span<const ClocklessExchange> exchanges);

/// T2 - d with the mean d, as the paper's «33 ms»; absent where no exchange was confirmed.
std::optional<std::vector<HostTime>> stamps_by_mean_delay(
    std::span<const ClocklessExchange> exchanges);

/// Where frames leave on a steady timer, their number plays the part of a counter: the earliest
/// arrivals over the number, bending by at most `curvature` (1/s), less the least d. Some ten times
/// better than T2 - d on a busy radio. Frames rise; absent where no exchange was confirmed.
std::optional<std::vector<HostTime>> stamps_by_frame_number(
    std::span<const ClocklessExchange> exchanges, double rate_hz, double curvature = 1e-8);

}  // namespace kinalign
