// SPDX-License-Identifier: Apache-2.0
// A node with a counter. It takes samples on a timer, sends one frame a period, and reads replies
// as they come; none of these waits for another. Datagrams: docs/formats/imu_node.md. 33 KiB, no
// heap.
#pragma once

#include "firmware/node/answer_gate.h"
#include "firmware/node/frame_pace.h"
#include "firmware/node/node_settings.h"
#include "firmware/node/sampler.h"

#include "kinalign/wire/node_frame.h"

namespace kinalign {

struct FrameCounts {
  std::uint64_t sent = 0;
  std::uint64_t send_fails = 0;  // the frame's number is lost, its samples go with the next frame
  std::uint64_t late = 0;  // frames after which others were left out because their time was over
  std::uint64_t samples_sent = 0;
  std::uint64_t unstampable = 0;  // samples later than their frame or over 71 min old: not sent
};

struct NodeTally {
  SampleCounts samples;
  FrameCounts frames;
  AnswerCounts replies;
};

class Node {
 public:
  Node(Board& board, const NodeSettings& settings);

  /// To be called on each tick of the sample timer with the number of ticks that are due. It may
  /// run in a task of its own; all other functions belong to one task.
  void tick(std::uint32_t due) { sampler_.tick(due); }
  /// Reads all datagrams that have arrived, sends the frame if one is due, and updates the lights.
  /// To be called when a datagram arrives and after idle_us. n_rx is read here, so a late call
  /// makes the host's interval wider, but never wrong.
  void poll();
  /// The time in us for which nothing has to be done unless a datagram arrives: at most 10 ms.
  std::uint32_t idle_us(std::uint64_t now_us) const;
  /// Sets whether the radio has a link. Without a link no frame is begun, and samples wait.
  void set_link(bool up) { lights_.link_up = up; }

  std::uint64_t replies_accepted() const { return gate_.counts().accepted; }
  NodeTally counts() { return {sampler_.counts(), counts_, gate_.counts()}; }

 private:
  void accept(std::span<const std::uint8_t> datagram, std::uint64_t n_rx_us);
  void send_frame();
  void gather();
  void stamp();
  void forget_or_keep(bool sent);
  void show(std::uint64_t now_us);
  const MacKey* key() const { return settings_.has_key ? &settings_.key : nullptr; }

  Board& board_;
  NodeSettings settings_;
  Sampler sampler_;
  AnswerGate gate_;
  FramePace pace_;
  FrameCounts counts_;
  ReplyEcho echo_;  // echo of the newest reply since the last frame that was sent
  bool has_echo_ = false;
  bool answered_ = false, locked_ = false;
  std::uint64_t answered_us_ = 0;
  Lights lights_;
  LightSwitch light_switch_;
  std::array<TakenSample, max_node_samples> gathered_{};  // samples for the next frame
  std::size_t gathered_count_ = 0;
  NodeFrame frame_;
  std::array<std::uint8_t, max_node_datagram> datagram_{};
};

}  // namespace kinalign
