// SPDX-License-Identifier: Apache-2.0
// What happens among the nodes, for who watches.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

struct NodeEvent {
  enum class Kind : std::uint8_t {
    joined,         // a stream begins
    started,        // its node has started (again), with a new boot id
    restarted,      // warning: its counter and sequence began anew under the same boot id
    twins,          // warning: two nodes have this id, each now has a stream
    renamed,        // `other_id` was what this node was called before
    moved,          // its frames come from another address
    left,           // nothing for ten seconds
    returned,       // and here it is again, in the same life
    newer_version,  // something speaks a later version of the protocol: `version`
    too_many,       // warning: a node was not taken in
    wrong_key       // warning: not heard, for what `refusal` says; the node's id is only claimed
  };
  Kind kind{};
  std::size_t stream = 0;
  std::uint32_t node_id = 0, boot_id = 0;
  HostTime at{};
  NodeAddress address;
  std::optional<std::uint32_t> other_id;
  std::uint8_t version = 0;
  NodeRefusal refusal = NodeRefusal::none;
};
inline constexpr std::size_t node_event_kinds = 11;

/// As in --json: "newer_version".
const char* name_of(NodeEvent::Kind kind);
bool is_warning(NodeEvent::Kind kind);

}  // namespace kinalign
