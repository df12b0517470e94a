// SPDX-License-Identifier: Apache-2.0
// The verdict on a datagram of the nodes' port, and on the echo in it. Each cause is counted
// separately.
#pragma once

#include "kinalign/capture/net/counts_by.h"
#include "kinalign/wire/node_datagram.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinalign {

enum class NodeVerdict : std::uint8_t {
  accepted,
  held,             // its session has not proved yet that it is not a recording played back
  duplicate,        // its sequence number was received before
  replayed,         // its sequence number or its counter lies too far back
  earlier_session,  // sent before its node started again
  limited,          // an unknown address that sends too often
  no_room,          // the table of nodes or of sessions is full
  wrong_counter,    // the counter is higher than a counter can be
  unknown_answer,   // a confirm of an answer that was not sent, or was already confirmed
  refused           // refused by wire; NodeRefusal gives the cause
};
inline constexpr std::size_t node_verdicts = 10;

enum class EchoVerdict : std::uint8_t {
  none,
  taken,
  repeated,  // the answer was named before; the node has received no newer one
  stale,     // the reply is older than the last 256
  unknown,   // the reply was not sent in this run
  future     // the reply arrived after the frame left
};
inline constexpr std::size_t echo_verdicts = 6;

/// The same word as in --json: "wrong_counter".
inline const char* name_of(NodeVerdict verdict) {
  static constexpr std::array<const char*, node_verdicts> names{
      "accepted", "held",    "duplicate",     "replayed",       "earlier_life",
      "limited",  "no_room", "wrong_counter", "unknown_answer", "refused"};
  return names[static_cast<std::size_t>(verdict)];
}

inline const char* name_of(EchoVerdict verdict) {
  static constexpr std::array<const char*, echo_verdicts> names{"none",  "taken",   "repeated",
                                                                "stale", "unknown", "future"};
  return names[static_cast<std::size_t>(verdict)];
}

/// Counts since the port was opened.
struct NodeCounts {
  CountsBy<NodeVerdict, node_verdicts> verdicts;  // each datagram is counted once
  CountsBy<NodeRefusal, node_refusals> refusals;  // refused datagrams
  CountsBy<EchoVerdict, echo_verdicts> echoes;    // echoes in frames of known sessions
  std::uint64_t answers = 0;
  std::uint64_t wrong_copies = 0;   // confirms whose T2 or T3 differs from the sent one
  std::uint64_t old_key = 0;        // datagrams with the key that was replaced
  std::uint8_t newest_version = 0;  // highest protocol version received that is not understood
};

}  // namespace kinalign
