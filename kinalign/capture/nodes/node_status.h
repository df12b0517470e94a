// SPDX-License-Identifier: Apache-2.0
// The state of one node while it sends: its counts, its rate and its clock.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/clock/clock_stamp.h"
#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// The state of one node at one instant.
/// A copy for display and for counts; it does not change with the node.
struct NodeStatus {
  std::size_t stream = 0;
  std::uint32_t node_id = 0, boot_id = 0;
  NodeAddress address;
  // `silent`: no datagram for ten seconds. `old_key`: it still uses the key that is being replaced.
  bool silent = false, old_key = false;
  // `sessions`: of the stream. `accepted`, `lost`: frames of the present life.
  std::uint64_t sessions = 0, accepted = 0, lost = 0;
  std::optional<double> rate_hz;            // absent before it is known, and for a silent node
  HostTime last_arrival{};                  // last arrival
  std::optional<std::uint16_t> battery_mv;  // absent if the node does not send it
  // The node's clock; absent if it has none.
  std::optional<NodeTime> n;  // its newest counter reading
  std::optional<ClockStamp> stamp;
  double drift = 0.0, drift_deviation = 0.0;  // rate of host_from_node minus 1, as estimated
  std::optional<Duration> round_trip;         // the shortest of the last complete ten seconds
  std::optional<Duration> one_way, mean_way;  // delay of a node without a counter: last and mean
};

}  // namespace kinalign
