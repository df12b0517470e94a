// SPDX-License-Identifier: Apache-2.0
// What the time server says of its nodes: lines for people, JSON objects for programs.
#pragma once

#include "kinalign/capture/node_receiver.h"

#include <string>
#include <vector>

namespace kinalign {

/// "node 7: two nodes have this id (192.168.7.21:4000)"; no line end.
std::string event_text(const NodeEvent& event);
std::string event_json(const NodeEvent& event);

/// `node_id`: whose clock. Empty where people need not be told.
std::string event_text(const ClockEvent& event, std::uint32_t node_id);
std::string event_json(const ClockEvent& event, std::size_t stream, std::uint32_t node_id);

std::string event_text(const HostClockEvent& event);
std::string event_json(const HostClockEvent& event);

/// "node 7  15.0/s, 0.2 % lost, ± 1.04 ms, drift +20.1 ± 0.4 ppm, round trip 2.00 ms, 3.91 V".
std::string status_text(const NodeStatus& status);
std::string status_json(const NodeStatus& status);
/// "3 nodes, 2 locked, 1 silent": who is silent is not locked, whatever its last frame was. Empty
/// without nodes.
std::string nodes_text(const std::vector<NodeStatus>& all);

/// "12 no mac, 3 bad crc": datagrams by what they were refused for; empty where none was.
std::string refused_text(const NodeCounts& counts);

std::string pair_json(const ClockPair& pair);
/// Each count by its name.
std::string node_counts_json(const NodeReceiver& receiver);

}  // namespace kinalign
