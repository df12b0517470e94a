// SPDX-License-Identifier: Apache-2.0
// A node without a counter (section 3.2 of the HFUT-MMD paper): a request a period with the sample
// of now, and each answer confirmed at once. The host takes the times. Datagrams:
// docs/formats/imu_node.md.
#pragma once

#include "firmware/node/answer_gate.h"
#include "firmware/node/board.h"
#include "firmware/node/node_settings.h"

namespace kinalign {

struct ClocklessCounts {
  std::uint64_t requests = 0;
  std::uint64_t request_fails = 0;  // its number and its sample are lost: later it has no time
  std::uint64_t missed = 0;         // ticks that were over before they were seen
  std::uint64_t sensor_fails = 0;
  std::uint64_t confirms = 0;
  std::uint64_t confirm_fails = 0;
  AnswerCounts answers;
};

class ClocklessNode {
 public:
  ClocklessNode(Board& board, const NodeSettings& settings);

  /// On each tick of the frame timer. Nothing here asks the board for its counter.
  void tick(std::uint32_t due);
  /// When a datagram arrives: from the answer to the confirm is a part of the paper's d.
  void poll();
  void set_link(bool up) { lights_.link_up = up; }
  const ClocklessCounts& counts() const { return counts_; }

 private:
  void accept(std::span<const std::uint8_t> datagram);
  void show();
  const MacKey* key() const { return settings_.has_key ? &settings_.key : nullptr; }

  Board& board_;
  NodeSettings settings_;
  AnswerGate gate_;
  ClocklessCounts counts_;
  std::uint32_t unanswered_ = 0;  // requests since the last answer
  bool answered_ = false;
  Lights lights_;
  LightSwitch light_switch_;
};

}  // namespace kinalign
