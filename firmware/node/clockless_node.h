// SPDX-License-Identifier: Apache-2.0
// A node without a counter (section 3.2 of the HFUT-MMD paper). It sends one request a period with
// the newest sample, and confirms each answer at once. The host takes all times. Datagrams:
// docs/formats/imu_node.md.
#pragma once

#include "firmware/node/answer_gate.h"
#include "firmware/node/board.h"
#include "firmware/node/node_settings.h"

namespace kinalign {

struct ClocklessCounts {
  std::uint64_t requests = 0;
  /// The request's number and sample are lost: without a counter it can't be sent later.
  std::uint64_t request_fails = 0;
  std::uint64_t missed = 0;  // ticks that passed before they were handled
  std::uint64_t sensor_fails = 0;
  std::uint64_t confirms = 0;
  std::uint64_t confirm_fails = 0;
  AnswerCounts answers;
};

class ClocklessNode {
 public:
  ClocklessNode(Board& board, const NodeSettings& settings);

  /// To be called on each tick of the frame timer. Nothing here reads the board's counter.
  void tick(std::uint32_t due);
  /// To be called when a datagram arrives: the time from the answer to the confirm is a part of the
  /// paper's d.
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
