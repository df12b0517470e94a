// SPDX-License-Identifier: Apache-2.0
// Texts about nodes, mostly for the time server: lines for people, JSON objects for programs.
#pragma once

#include "apps/kinalign/text/node_names.h"

#include "kinalign/capture/nodes/node_receiver.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The address and the port of a node: "192.168.7.21:4000".
std::string address_text(const NodeAddress& address);
inline std::int64_t json_ns(HostTime t) { return t.time_since_epoch().count(); }

/// The state of a node in one line: "node 7  15.0/s, 0.2 % lost, ± 1.04 ms, drift +20.1 ± 0.4 ppm,
/// round trip 2.00 ms, 3.91 V". The line of a silent node is "node 7  silent since
/// 2026-11-22T17:38:23Z, …". Unknown parts are left out. `why`: the reason why the node is not
/// locked, if the caller knows more than the stamp says.
std::string status_text(const NodeStatus& status, const ClockPair& now, std::string_view why = {});
std::string status_json(const NodeStatus& status);
/// The number of nodes: "3 nodes, 2 locked, 1 silent". A silent node does not count as locked, even
/// if its last frame was. Empty without nodes.
std::string nodes_text(const std::vector<NodeStatus>& all);

/// The number of refused datagrams by cause: "12 no mac, 3 bad crc". Empty if none was refused.
std::string refused_text(const NodeCounts& counts);

/// A line for each of the three causes that concern keys, such as "wrong mac: senders that call
/// themselves node 11, 12, 13 (12 frames)". The datagrams state these ids; no key proves them.
std::vector<std::string> claims_text(const RefusedNodes& refused, const NodeCounts& counts,
                                     const NodeNames& names = {});

/// refused_text() and claims_text() as whole lines. Empty if no datagram was refused.
std::string refused_lines(const NodeReceiver& receiver, const NodeNames& names = {});

std::string pair_json(const ClockPair& pair);
/// The receiver's counts as JSON, each under its name.
std::string node_counts_json(const NodeReceiver& receiver);

}  // namespace kinalign
