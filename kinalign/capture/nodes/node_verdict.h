// SPDX-License-Identifier: Apache-2.0
// The verdict on a datagram of the nodes' port, and the verdict on the echo in a datagram. Each
// verdict is counted separately. An echo is the part of a frame that names an answer of the host. A
// confirm is a datagram with which a node without a clock names an answer.
#pragma once

#include "kinalign/capture/net/counts_by.h"
#include "kinalign/wire/node_datagram.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinalign {

enum class NodeVerdict : std::uint8_t {
  accepted,
  held,             // the session has not proved yet that it is not a replayed recording
  duplicate,        // the sequence number was received before
  replayed,         // the sequence number or the counter is too far behind
  earlier_session,  // sent before the node started again
  limited,          // an unknown address sends too often
  no_room,          // the table of nodes or of sessions is full
  wrong_counter,    // the counter is higher than a counter can be
  unknown_answer,   // confirms an answer that was not sent or is already confirmed
  refused           // refused by decode (kinalign/wire); NodeRefusal gives the cause
};
inline constexpr std::size_t node_verdicts = 10;

enum class EchoVerdict : std::uint8_t {
  none,
  taken,
  repeated,  // the node has named this answer before; it has received no newer answer
  stale,     // the answer is older than the last 256 answers
  unknown,   // the answer was not sent in this run
  future     // the stated arrival of the answer is after the frame's departure
};
inline constexpr std::size_t echo_verdicts = 6;

/// Returns the word for the verdict in --json output, such as "wrong_counter".
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
  CountsBy<NodeRefusal, node_refusals> refusals;  // refused datagrams by cause
  CountsBy<EchoVerdict, echo_verdicts> echoes;    // echoes in frames of known sessions
  std::uint64_t answers = 0;
  std::uint64_t wrong_copies = 0;   // confirms whose T2 or T3 differs from the value that was sent
  std::uint64_t old_key = 0;        // datagrams with the key that is being replaced
  std::uint8_t newest_version = 0;  // highest received protocol version that is not supported
};

}  // namespace kinalign
