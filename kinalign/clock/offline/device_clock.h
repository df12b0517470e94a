// SPDX-License-Identifier: Apache-2.0
// The clock of one device over a whole recording. The counter's readings become stamps on one time
// axis that continues over restarts. A model converts these stamps to UTC.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/clock/time_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace kinalign {

/// `moved` and `pieces_of` contain indices of the pieces of `model`.
struct DeviceClock {
  HostFromNode model;  // a piece without knots gives no times
  /// The duration added to the counter in each piece. Up to the first restart or backward step it
  /// is 0, so stamps equal readings. After a restart, stamps continue by as much as the host's
  /// clock advanced.
  std::vector<Duration> moved;
  /// The pieces with knots of each boot.
  std::unordered_map<BootKey, std::vector<std::size_t>> pieces_of;
  TimeModel time;  // from stamps to UTC; has half-widths where a piece is certified
};

/// Exchanges must be in the order of arrival. Boots with replies get certified times
/// (offline_clock.h). Other boots use the earliest arrivals (one_way_clock.h). `utc_minus_host` is
/// that of the recording.
DeviceClock device_clock(std::span<const Exchange> exchanges, Duration utc_minus_host);

/// Returns the stamp of the reading n in a frame that arrived at h_rx, using the nearest piece of
/// that boot. Absent if there is no such piece.
std::optional<Time> stamp_of(const DeviceClock& clock, BootKey boot, NodeTime n, HostTime h_rx);

}  // namespace kinalign
