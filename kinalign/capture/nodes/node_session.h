// SPDX-License-Identifier: Apache-2.0
// The host's record of one session of a node. A session lasts from one start of the node to the
// next.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/capture/nodes/answer_pace.h"
#include "kinalign/capture/nodes/answer_table.h"
#include "kinalign/capture/nodes/node_counter.h"
#include "kinalign/clock/exchange.h"

#include <cstddef>
#include <cstdint>

namespace kinalign {

/// If the state is free, the other members have no meaning. When the place is reused, all members
/// are set anew.
struct NodeSession {
  enum class State : std::uint8_t {
    free,
    held,    // not admitted yet; the node must first echo an answer of this run
    live,    // the present session of its stream
    earlier  // the node has started again since this session
  };
  State state = State::free;
  std::uint32_t node_id = 0, boot_id = 0;
  BootKey key = 0;  // the boot id, and in the upper bits a number if this boot id was used before
  std::size_t stream = 0;  // undefined while the session is held
  NodeAddress address;     // source address of its newest frame
  // Arrival of the first and the newest frame, and the start of the next session.
  HostTime begun{}, last_arrival{}, replaced{};
  bool old_key = false;  // the newest frame was signed with the key that is being replaced
  Counter sequences;
  NodeCounter counter;
  AnswerTable answers;
  AnswerPace pace;
  std::uint32_t next_reply = 0;
  std::uint64_t accepted = 0;
};

}  // namespace kinalign
