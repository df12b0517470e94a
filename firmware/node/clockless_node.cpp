// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/clockless_node.h"

#include "firmware/node/arrivals.h"

#include "kinalign/wire/clockless.h"

namespace kinalign {

namespace {

constexpr std::size_t longest = 128;  // a request with a sample and a MAC: 101 bytes
constexpr std::uint32_t unanswered_after_us = 3'000'000;

}  // namespace

ClocklessNode::ClocklessNode(Board& board, const NodeSettings& settings)
    : board_(board), settings_(settings), gate_({settings.node_id, settings.boot_id, 0}) {}

void ClocklessNode::tick(std::uint32_t due) {
  if (due == 0) return;
  counts_.missed += due - 1;
  if (!lights_.link_up) return show();
  ClocklessRequest request;
  request.origin = gate_.issue();
  request.has_sample = board_.read_imu(request.sample);
  if (!request.has_sample) {
    request.sample = {};
    ++counts_.sensor_fails;
  }
  request.has_battery = board_.read_battery(request.battery_mv);
  std::array<std::uint8_t, longest> room{};
  ++(board_.send(encode(request, key(), room)) ? counts_.requests : counts_.request_fails);
  if (++unanswered_ >
      (unanswered_after_us + settings_.frame_period_us / 2) / settings_.frame_period_us)
    answered_ = false;
  lights_.battery = battery_light(request.has_battery, request.battery_mv);
  show();
}

void ClocklessNode::poll() {
  for_arrivals(board_, [this](std::span<const std::uint8_t> datagram) { accept(datagram); });
  show();
}

void ClocklessNode::accept(std::span<const std::uint8_t> datagram) {
  ClocklessAnswer answer;
  const NodeRefusal refusal = open_and_decode(datagram, key(), answer);
  if (refusal != NodeRefusal::none) return gate_.refuse(refusal);
  if (!gate_.admit(answer.origin)) return;
  std::array<std::uint8_t, longest> room{};
  const auto confirm = encode(ClocklessConfirm{answer.origin, answer.times}, key(), room);
  ++(board_.send(confirm) ? counts_.confirms : counts_.confirm_fails);
  answered_ = true;
  unanswered_ = 0;
}

void ClocklessNode::show() {
  counts_.answers = gate_.counts();
  lights_.sync = answered_ ? SyncLight::answered : SyncLight::unanswered;
  light_switch_.show(board_, lights_);
}

}  // namespace kinalign
