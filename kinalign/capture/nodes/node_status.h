// SPDX-License-Identifier: Apache-2.0
// The state of one node at one moment: its counts, its rate and its clock.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/clock/clock_stamp.h"
#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// A copy for display and for counts. It does not change with the node.
struct NodeStatus {
  std::size_t stream = 0;
  std::uint32_t node_id = 0, boot_id = 0;
  NodeAddress address;
  // `silent`: no datagram for ten seconds. `old_key`: the node uses the key that is being replaced.
  bool silent = false, old_key = false;
  // `sessions`: starts of this node. `accepted`, `lost`: frames of the present session.
  std::uint64_t sessions = 0, accepted = 0, lost = 0;
  std::optional<double> rate_hz;            // absent in the first second and for a silent node
  HostTime last_arrival{};                  // last arrival
  std::optional<std::uint16_t> battery_mv;  // absent if the node does not send it
  // The node's clock; absent if it has none.
  std::optional<NodeTime> n;  // newest reading of the node's counter
  std::optional<ClockStamp> stamp;
  // Rate of the host's clock against the node's, minus 1, and the standard deviation.
  double drift = 0.0, drift_deviation = 0.0;
  std::optional<Duration> round_trip;         // the shortest of the last complete ten seconds
  std::optional<Duration> one_way, mean_way;  // delay of a node without a counter: last and mean
};

}  // namespace kinalign
