// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/node.h"

#include "kinalign/wire/node_reply.h"

namespace kinalign {

namespace {

constexpr std::size_t answer_room = 64;  // the longest has 56 bytes; a longer datagram is refused
constexpr int answers_a_poll = 16;       // a flood delays a frame by no more than these
constexpr std::uint32_t longest_idle_us = 10'000;
constexpr std::uint64_t unanswered_after_us = 3'000'000;
constexpr std::uint16_t low_battery_mv = 3500;  // one lithium cell: a tenth of its charge is left

}  // namespace

Node::Node(Board& board, const NodeSettings& settings)
    : board_(board),
      settings_(settings),
      sampler_(board),
      gate_({settings.node_id, settings.boot_id, 0}),
      pace_(settings.frame_period_us, settings.dither_us, settings.boot_id) {}

void Node::poll() {
  receive();
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

void Node::receive() {
  std::array<std::uint8_t, answer_room> room{};
  std::size_t size = 0;
  for (int i = 0; i < answers_a_poll && board_.receive(room, size); ++i) {
    const std::uint64_t n_rx_us = board_.counter_us();
    accept(std::span(room).first(size), n_rx_us);
  }
}

void Node::accept(std::span<const std::uint8_t> datagram, std::uint64_t n_rx_us) {
  Envelope envelope;
  NodeReply reply;
  NodeRefusal refusal = open_envelope(datagram, envelope);
  if (refusal == NodeRefusal::none) refusal = decode(envelope, key(), reply);
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

/// The counter is read here, after all but the copying, the MAC and the CRC, which need it.
void Node::stamp() {
  const std::uint64_t n_tx_us = board_.counter_us();
  frame_.n_tx_us = n_tx_us;
  frame_.sample_count = 0;
  for (std::size_t i = 0; i < gathered_count_; ++i) {
    const std::uint64_t age_us = n_tx_us - gathered_[i].counter_us;  // huge where it is later
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

/// What was not sent waits with its samples and its echo; its number does not come again. Where the
/// ring overflows meanwhile, the samples here are the oldest, and go first.
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
  lights_.battery = !frame_.has_battery                  ? BatteryLight::unknown
                    : frame_.battery_mv < low_battery_mv ? BatteryLight::low
                                                         : BatteryLight::good;
  if (ever_shown_ && lights_ == shown_) return;
  ever_shown_ = true;
  shown_ = lights_;
  board_.show(lights_);
}

}  // namespace kinalign
