// SPDX-License-Identifier: Apache-2.0
// Nodes without a clock, as in section 3.2 of the HFUT-MMD paper. The host stamps the arrival of a
// frame (T2), the departure of its answer (T3) and the arrival of the node's confirmation (T6). The
// delay of a frame is estimated as d = (T6 - T3) / 2, its departure as T2 - d. No stamp is
// certified, because d is half a round trip of other packets plus half of the node's processing
// time. docs/clock.md gives the resulting errors.
#pragma once

#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

struct ClocklessExchange {
  std::uint64_t frame = 0;  // frame number since the node's start plus 2^32, including lost frames
  HostTime t2{}, t3{};
  std::optional<HostTime> t6;  // absent: the answer or its confirmation was lost
  BootKey boot = 0;            // boot of the node
};

/// The delay d. It is absent if there is no t6.
std::optional<Duration> one_way_delay(const ClocklessExchange& exchange);

/// The least delay of all exchanges. Absent if no exchange was confirmed.
std::optional<Duration> least_one_way_delay(std::span<const ClocklessExchange> exchanges);

/// Returns T2 - d with the delay d of each frame; absent for a frame without d. This function and
/// the next are the two methods of the HFUT-MMD paper. The third function is kinalign's method.
/// docs/clock.md compares them.
std::vector<std::optional<HostTime>> stamps_by_each_delay(
    std::span<const ClocklessExchange> exchanges);

/// Returns T2 - d with the mean of all d (33 ms in the HFUT-MMD paper). Absent if no exchange was
/// confirmed.
std::optional<std::vector<HostTime>> stamps_by_mean_delay(
    std::span<const ClocklessExchange> exchanges);

/// For frames that are sent on a regular timer, so that the frame number replaces a counter. The
/// stamps are the earliest arrivals as a function of the number, minus the least d. Their rate
/// changes by at most `curvature` (1/s). On a busy radio link they are about ten times better than
/// T2 - d. Frame numbers must rise. Absent if no exchange was confirmed.
std::optional<std::vector<HostTime>> stamps_by_frame_number(
    std::span<const ClocklessExchange> exchanges, double rate_hz, double curvature = 1e-8);

}  // namespace kinalign
