// SPDX-License-Identifier: Apache-2.0
// What became of a datagram on the nodes' port, and of the echo in it: each cause is counted by
// itself.
#pragma once

#include "kinalign/capture/net/counts_by.h"
#include "kinalign/capture/nodes/answer_table.h"
#include "kinalign/wire/node_datagram.h"

#include <cstddef>
#include <cstdint>

namespace kinalign {

enum class NodeVerdict : std::uint8_t {
  accepted,
  held,            // of a life that has not shown yet that it is not a recording played back
  duplicate,       // its sequence was seen
  replayed,        // its sequence or its counter lies too far back
  earlier_life,    // was on its way while its node started again
  limited,         // a stranger's address that asks too often
  no_room,         // more nodes, or starts at once, than are kept
  wrong_counter,   // more than a counter can show
  unknown_answer,  // a confirm of nothing that was asked, or of what was confirmed
  refused          // by wire: NodeRefusal says why
};
inline constexpr std::size_t node_verdicts = 10;

enum class EchoVerdict : std::uint8_t {
  none,
  taken,
  repeated,  // the node has heard nothing newer
  stale,     // of a reply before the last 256
  unknown,   // of a reply that was not sent in this run
  future     // it arrived after the frame left
};
inline constexpr std::size_t echo_verdicts = 6;

/// As in --json: "wrong_counter".
const char* name_of(NodeVerdict verdict);
const char* name_of(EchoVerdict verdict);

/// Of an echo that names an answer.
EchoVerdict echo_verdict(AnswerTable::Found found);

struct NodeCounts {
  CountsBy<NodeVerdict, node_verdicts> verdicts;  // each datagram once
  CountsBy<NodeRefusal, node_refusals> refusals;  // of those that are refused
  CountsBy<EchoVerdict, echo_verdicts> echoes;    // of frames of known lives
  std::uint64_t answers = 0;
  std::uint64_t wrong_copies = 0;   // confirms whose T2 or T3 is not what was sent
  std::uint64_t old_key = 0;        // came with the key that was replaced
  std::uint8_t newest_version = 0;  // of those that are not understood
};

}  // namespace kinalign
