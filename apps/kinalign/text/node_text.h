// SPDX-License-Identifier: Apache-2.0
// The text about nodes, above all for the time server: lines for people, JSON objects for programs.
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

/// "node 7  15.0/s, 0.2 % lost, ± 1.04 ms, drift +20.1 ± 0.4 ppm, round trip 2.00 ms, 3.91 V"; for
/// a silent node "node 7  silent since 2026-11-22T17:38:23Z, …". `why`: the reason why the node is
/// not locked, if more is known than its stamp says.
/// One line per node, so a table of nodes can be made of these lines. Parts that are not known are
/// left out.
std::string status_text(const NodeStatus& status, const ClockPair& now, std::string_view why = {});
std::string status_json(const NodeStatus& status);
/// "3 nodes, 2 locked, 1 silent". A silent node does not count as locked, whatever its last frame
/// was. Empty without nodes.
std::string nodes_text(const std::vector<NodeStatus>& all);

/// "12 no mac, 3 bad crc": the refused datagrams by cause. Empty if none was refused.
std::string refused_text(const NodeCounts& counts);

/// "wrong mac: from what says it is node 11, 12, 13 (12 frames)": a line for each of the three
/// causes that concern keys. The ids are stated by the datagrams and not proved.
std::vector<std::string> claims_text(const RefusedNodes& refused, const NodeCounts& counts,
                                     const NodeNames& names = {});

/// Both texts as whole lines. Empty if nothing was refused.
std::string refused_lines(const NodeReceiver& receiver, const NodeNames& names = {});

std::string pair_json(const ClockPair& pair);
/// Every count under its name.
std::string node_counts_json(const NodeReceiver& receiver);

}  // namespace kinalign
