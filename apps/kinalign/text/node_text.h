// SPDX-License-Identifier: Apache-2.0
// What is said of nodes, by the time server above all: lines for people, JSON objects for programs.
#pragma once

#include "apps/kinalign/text/node_names.h"

#include "kinalign/capture/nodes/node_receiver.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// "192.168.7.21:4000".
std::string address_text(const NodeAddress& address);
inline std::int64_t json_ns(HostTime t) { return t.time_since_epoch().count(); }

/// "node 7  15.0/s, 0.2 % lost, ± 1.04 ms, drift +20.1 ± 0.4 ppm, round trip 2.00 ms, 3.91 V"; of
/// who is silent "node 7  silent since 2026-11-22T17:38:23Z, …". `why` it
/// is not locked, where more is known than its stamp says.
std::string status_text(const NodeStatus& status, const ClockPair& now, std::string_view why = {});
std::string status_json(const NodeStatus& status);
/// "3 nodes, 2 locked, 1 silent": who is silent is not locked, whatever its last frame was. Empty
/// without nodes.
std::string nodes_text(const std::vector<NodeStatus>& all);

/// "12 no mac, 3 bad crc": datagrams by what they were refused for; empty where none was.
std::string refused_text(const NodeCounts& counts);

/// "wrong mac: from what says it is node 11, 12, 13 (12 frames)": a line for each cause of the
/// three that have to do with keys; of datagrams whose ids nobody vouches for.
std::vector<std::string> claims_text(const RefusedNodes& refused, const NodeCounts& counts,
                                     const NodeNames& names = {});

/// Both, as whole lines; empty where nothing was refused.
std::string refused_lines(const NodeReceiver& receiver, const NodeNames& names = {});

std::string pair_json(const ClockPair& pair);
/// Each count by its name.
std::string node_counts_json(const NodeReceiver& receiver);

}  // namespace kinalign
