// SPDX-License-Identifier: Apache-2.0
// What the host remembers of one start of one node.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/capture/nodes/answer_pace.h"
#include "kinalign/capture/nodes/answer_table.h"
#include "kinalign/capture/nodes/node_counter.h"
#include "kinalign/capture/nodes/sequence_window.h"
#include "kinalign/clock/exchange.h"

#include <cstddef>
#include <cstdint>

namespace kinalign {

struct NodeLife {
  enum class State : std::uint8_t {
    free,
    held,    // until it echoes what this run of the host sent to it
    live,    // the present one of its stream
    earlier  // its node has started again
  };
  State state = State::free;
  std::uint32_t node_id = 0, boot_id = 0;
  BootKey key = 0;         // boot id, and above it a number where that came before
  std::size_t stream = 0;  // but while it is held
  NodeAddress address;     // that its newest frame came from
  HostTime begun{}, heard{}, replaced{};
  bool old_key = false;  // its newest frame had the key that is being replaced
  SequenceWindow sequences;
  NodeCounter counter;
  AnswerTable answers;
  AnswerPace pace;
  std::uint32_t next_reply = 0;
  std::uint64_t accepted = 0;
};

}  // namespace kinalign
