// SPDX-License-Identifier: Apache-2.0
// The clock of one device over a whole recording, as a stream carries it: its counter as stamps on
// one axis that goes on over restarts, and the model from these to UTC.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/clock/time_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace kinalign {

struct DeviceClock {
  HostFromNode model;  // pieces without any knots are of nothing that was heard
  /// Of each piece: what is added to its counter. 0 up to the first restart or step back: stamps
  /// are the counter's readings. Behind one they go on as long after as the host counted.
  std::vector<Duration> moved;
  std::unordered_map<BootKey, std::vector<std::size_t>> pieces_of;  // of a life, with knots
  TimeModel time;  // from stamps to UTC; half-widths where a piece is certified
};

/// Exchanges in the order of arrival. Lives that were answered are certified (offline_clock.h), of
/// others the earliest arrivals speak (one_way_clock.h). `utc_minus_host` is the recording's.
DeviceClock device_clock(std::span<const Exchange> exchanges, Duration utc_minus_host);

/// The stamp of the counter's reading n in what arrived at h_rx, by the piece of that life that is
/// nearest. Absent where nothing of that life was heard.
std::optional<Time> stamp_of(const DeviceClock& clock, BootKey boot, NodeTime n, HostTime h_rx);

}  // namespace kinalign
