// SPDX-License-Identifier: Apache-2.0
// The clock of one device over a whole recording, in the form of a stream. The counter's readings
// become stamps on one axis that continues over restarts, and a model maps these stamps to UTC.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/clock/time_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace kinalign {

/// `moved` and `pieces_of` index the pieces of `model`.
struct DeviceClock {
  HostFromNode model;  // pieces without knots: nothing is known of them
  /// For each piece: the duration added to its counter. It is 0 up to the first restart or step
  /// back, so stamps equal readings. After one, stamps continue by as much as the host's clock
  /// advanced.
  std::vector<Duration> moved;
  /// For each boot, its pieces with knots.
  std::unordered_map<BootKey, std::vector<std::size_t>> pieces_of;
  TimeModel time;  // from stamps to UTC; half-widths are set where a piece is certified
};

/// Exchanges must be in the order of arrival. Boots with replies are certified (offline_clock.h).
/// For others the earliest arrivals are used (one_way_clock.h). `utc_minus_host` belongs to the
/// recording.
DeviceClock device_clock(std::span<const Exchange> exchanges, Duration utc_minus_host);

/// The stamp of reading n in a frame that arrived at h_rx, by the nearest piece of that boot.
/// Absent if there is no such piece.
std::optional<Time> stamp_of(const DeviceClock& clock, BootKey boot, NodeTime n, HostTime h_rx);

}  // namespace kinalign
