// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/node.h"

#include "firmware/node/arrivals.h"

#include "kinalign/wire/node_reply.h"

namespace kinalign {

namespace {

constexpr std::uint32_t longest_idle_us = 10'000;
constexpr std::uint64_t unanswered_after_us = 3'000'000;

}  // namespace

Node::Node(Board& board, const NodeSettings& settings)
    : board_(board),
      settings_(settings),
      sampler_(board),
      gate_({settings.node_id, settings.boot_id, 0}),
      pace_(settings.frame_period_us, settings.dither_us, settings.boot_id) {}

void Node::poll() {
  for_arrivals(board_, [this](std::span<const std::uint8_t> datagram) {
    // Read before anything else, to be as early as possible.
    const std::uint64_t n_rx_us = board_.counter_us();
    accept(datagram, n_rx_us);
  });
  const std::uint64_t now_us = board_.counter_us();
  if (lights_.link_up && pace_.due(now_us)) {
    send_frame();
    if (!pace_.advance(now_us)) ++counts_.late;
  }
  show(now_us);
}

std::uint32_t Node::idle_us(std::uint64_t now_us) const {
  if (!lights_.link_up || pace_.next_us() > now_us + longest_idle_us) return longest_idle_us;
  return pace_.next_us() > now_us ? static_cast<std::uint32_t>(pace_.next_us() - now_us) : 0;
}

void Node::accept(std::span<const std::uint8_t> datagram, std::uint64_t n_rx_us) {
  NodeReply reply;
  const NodeRefusal refusal = open_and_decode(datagram, key(), reply);
  if (refusal != NodeRefusal::none) return gate_.refuse(refusal);
  if (!gate_.admit(reply.origin)) return;
  echo_ = {reply.reply_sequence, reply.nonce, n_rx_us};
  has_echo_ = answered_ = true;
  locked_ = reply.locked;
  answered_us_ = n_rx_us;
}

void Node::send_frame() {
  gather();
  frame_.origin = gate_.issue();
  frame_.has_battery = board_.read_battery(frame_.battery_mv);
  frame_.has_echo = has_echo_;
  frame_.echo = echo_;
  stamp();
  const auto datagram = encode(frame_, key(), datagram_);
  forget_or_keep(board_.send(datagram));
}

void Node::gather() {
  gathered_count_ += sampler_.take(std::span(gathered_).subspan(gathered_count_));
}

/// Stamps the frame. The counter is read here, as late as possible: only copying, MAC and CRC
/// follow, and they need the stamp.
void Node::stamp() {
  const std::uint64_t n_tx_us = board_.counter_us();
  frame_.n_tx_us = n_tx_us;
  frame_.sample_count = 0;
  for (std::size_t i = 0; i < gathered_count_; ++i) {
    // A sample later than its frame gives a huge number.
    const std::uint64_t age_us = n_tx_us - gathered_[i].counter_us;
    if (age_us > UINT32_MAX) continue;
    NodeSample& sample = frame_.samples[frame_.sample_count++];
    sample = gathered_[i].sample;
    sample.age_us = static_cast<std::uint32_t>(age_us);
  }
  if (settings_.narrow_counter) {
    frame_.n_tx_us &= UINT32_MAX;
    frame_.echo.n_rx_us &= UINT32_MAX;
  }
}

/// A frame that was not sent keeps its samples and its echo for the next frame; its number is not
/// used again. If the ring is full meanwhile, the samples here are the oldest, and are dropped
/// first.
void Node::forget_or_keep(bool sent) {
  if (sent) {
    ++counts_.sent;
    counts_.samples_sent += frame_.sample_count;
    counts_.unstampable += gathered_count_ - frame_.sample_count;
    gathered_count_ = 0;
    has_echo_ = false;
    return;
  }
  ++counts_.send_fails;
  if (sampler_.full()) {
    sampler_.count_dropped(gathered_count_);
    gathered_count_ = 0;
  }
}

void Node::show(std::uint64_t now_us) {
  if (answered_ && now_us - answered_us_ > unanswered_after_us) answered_ = false;
  lights_.sync = !answered_ ? SyncLight::unanswered
                 : locked_  ? SyncLight::locked
                            : SyncLight::answered;
  lights_.battery = battery_light(frame_.has_battery, frame_.battery_mv);
  light_switch_.show(board_, lights_);
}

}  // namespace kinalign
