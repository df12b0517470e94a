// SPDX-License-Identifier: Apache-2.0
// An event of a node, of its clock or of this machine: a line for people, a JSON object for
// programs.
#pragma once

#include "apps/kinalign/text/node_names.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/capture/nodes/node_event.h"
#include "kinalign/clock/clock_event.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace kinalign {

/// "node 7: two nodes have this id (192.168.7.21:4000)"; no line end.
/// `names` gives the places of lab.toml; without it a node is called by its id.
std::string event_text(const NodeEvent& event, const NodeNames& names = {});
std::string event_json(const NodeEvent& event);

/// `node_id`: the node that the clock belongs to. Empty for events that people need not read.
std::string event_text(const ClockEvent& event, std::uint32_t node_id, const NodeNames& names = {});
std::string event_json(const ClockEvent& event, std::size_t stream, std::uint32_t node_id);

std::string event_text(const HostClockEvent& event);
std::string event_json(const HostClockEvent& event);

}  // namespace kinalign
