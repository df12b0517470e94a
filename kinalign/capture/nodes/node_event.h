// SPDX-License-Identifier: Apache-2.0
// Events about nodes, for display and logs.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// Members that the comment of a kind does not mention keep their defaults.
struct NodeEvent {
  enum class Kind : std::uint8_t {
    joined,         // a new stream begins
    started,        // the node of the stream has started again, with a new boot id
    restarted,      // warning: counter and sequence number began again under the same boot id
    twins,          // warning: two nodes have this id; each now has its own stream
    renamed,        // the node was known as `other_id` before
    moved,          // the node's frames come from another address
    left,           // the node was silent for ten seconds
    returned,       // the node sends again after `left`, without a restart
    newer_version,  // a datagram has a later protocol version: `version`
    too_many,       // warning: a node was not admitted, because the table is full
    wrong_key       // warning: refused because of its key, see `refusal`; the node id is not proved
  };
  Kind kind{};
  std::size_t stream = 0;
  std::uint32_t node_id = 0, boot_id = 0;
  HostTime at{};
  NodeAddress address{};
  std::optional<std::uint32_t> other_id{};
  std::uint8_t version = 0;
  NodeRefusal refusal = NodeRefusal::none;
};
inline constexpr std::size_t node_event_kinds = 11;

/// Returns the word for the kind in --json output, such as "newer_version".
inline const char* name_of(NodeEvent::Kind kind) {
  static constexpr std::array<const char*, node_event_kinds> names{
      "joined", "started",  "restarted",     "twins",    "renamed",  "moved",
      "left",   "returned", "newer_version", "too_many", "wrong_key"};
  return names[static_cast<std::size_t>(kind)];
}

inline bool is_warning(NodeEvent::Kind kind) {
  return kind == NodeEvent::Kind::restarted || kind == NodeEvent::Kind::twins ||
         kind == NodeEvent::Kind::too_many || kind == NodeEvent::Kind::wrong_key;
}

}  // namespace kinalign
