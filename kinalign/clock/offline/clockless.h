// SPDX-License-Identifier: Apache-2.0
// Nodes without a clock, as in section 3.2 of the HFUT-MMD paper. The host stamps the arrival of a
// frame (T2), its answer (T3) and the node's confirmation of the answer (T6). It takes d = (T6 -
// T3) / 2 as the delay of a frame and T2 - d as the time of sending. There is no certificate: d is
// half a round trip of other packets and half of the node's processing time. docs/clock.md gives
// the resulting errors.
#pragma once

#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

struct ClocklessExchange {
  std::uint64_t frame = 0;  // frame number since the node's start plus 2^32; lost frames count
  HostTime t2{}, t3{};
  std::optional<HostTime> t6;  // absent: the answer or its confirmation was lost
  BootKey boot = 0;            // the node's boot
};

/// Absent without t6.
std::optional<Duration> one_way_delay(const ClocklessExchange& exchange);

/// The least delay of all exchanges; absent if none was confirmed.
std::optional<Duration> least_one_way_delay(std::span<const ClocklessExchange> exchanges);

/// T2 - d with each frame's own d; absent for a frame without one.
/// The three functions below are the paper's two methods and ours, for the comparison in
/// docs/clock.md.
std::vector<std::optional<HostTime>> stamps_by_each_delay(
    std::span<const ClocklessExchange> exchanges);

/// T2 - d with the mean d, such as the paper's «33 ms»; absent if no exchange was confirmed.
std::optional<std::vector<HostTime>> stamps_by_mean_delay(
    std::span<const ClocklessExchange> exchanges);

/// For frames that leave on a steady timer, so that their number replaces a counter. The stamps are
/// the earliest arrivals over the number, with a rate that changes by at most `curvature` (1/s),
/// minus the least d. On a busy radio link some ten times better than T2 - d. Frame numbers must
/// rise; absent if no exchange was confirmed.
std::optional<std::vector<HostTime>> stamps_by_frame_number(
    std::span<const ClocklessExchange> exchanges, double rate_hz, double curvature = 1e-8);

}  // namespace kinalign
