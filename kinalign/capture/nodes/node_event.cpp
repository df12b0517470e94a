// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_event.h"

#include <array>

namespace kinalign {

const char* name_of(NodeEvent::Kind kind) {
  static constexpr std::array<const char*, node_event_kinds> names{
      "joined", "started",  "restarted",     "twins",    "renamed",  "moved",
      "left",   "returned", "newer_version", "too_many", "wrong_key"};
  return names[static_cast<std::size_t>(kind)];
}

bool is_warning(NodeEvent::Kind kind) {
  return kind == NodeEvent::Kind::restarted || kind == NodeEvent::Kind::twins ||
         kind == NodeEvent::Kind::too_many || kind == NodeEvent::Kind::wrong_key;
}

}  // namespace kinalign
