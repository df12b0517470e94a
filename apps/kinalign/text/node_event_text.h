// SPDX-License-Identifier: Apache-2.0
// Describes an event of a node, of a node's clock or of this machine's clock: a line for people, a
// JSON object for programs.
#pragma once

#include "apps/kinalign/text/node_names.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/capture/nodes/node_event.h"
#include "kinalign/clock/clock_event.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace kinalign {

/// The event in words, without a line end: "node 7: two nodes have this id (192.168.7.21:4000)".
/// `names` gives the places of the nodes from lab.toml. Without `names` a node is called by its id.
std::string event_text(const NodeEvent& event, const NodeNames& names = {});
std::string event_json(const NodeEvent& event);

/// The event in words. `node_id`: the node whose clock it is. Empty for an event that people need
/// not read.
std::string event_text(const ClockEvent& event, std::uint32_t node_id, const NodeNames& names = {});
std::string event_json(const ClockEvent& event, std::size_t stream, std::uint32_t node_id);

std::string event_text(const HostClockEvent& event);
std::string event_json(const HostClockEvent& event);

}  // namespace kinalign
