// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_verdict.h"

namespace kinalign {

const char* name_of(NodeVerdict verdict) {
  static constexpr std::array<const char*, node_verdicts> names{
      "accepted", "held",    "duplicate",     "replayed",       "earlier_life",
      "limited",  "no_room", "wrong_counter", "unknown_answer", "refused"};
  return names[static_cast<std::size_t>(verdict)];
}

const char* name_of(EchoVerdict verdict) {
  static constexpr std::array<const char*, echo_verdicts> names{"none",  "taken",   "repeated",
                                                                "stale", "unknown", "future"};
  return names[static_cast<std::size_t>(verdict)];
}

}  // namespace kinalign
