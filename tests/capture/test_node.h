// SPDX-License-Identifier: Apache-2.0
// A node for tests of the host: its counter follows the host's clock as the test sets it, it makes
// frames and accepts replies. All times are arguments.
#pragma once

#include "kinalign/capture/nodes/node_responder.h"
#include "kinalign/wire/node_reply.h"

#include <optional>
#include <vector>

namespace kinalign {

using Bytes = std::vector<std::uint8_t>;

inline HostTime host_s(double s) {
  return HostTime{std::chrono::hours(24)} + Duration{static_cast<std::int64_t>(s * 1e9)};
}

inline NodeAddress address_of(std::uint8_t last, std::uint16_t port = 4000) {
  return {mapped_ipv4(std::array<std::uint8_t, 4>{192, 168, 7, last}), port};
}

class TestNode {
 public:
  TestNode(std::uint32_t id, std::uint32_t boot_id, const std::optional<LabKey>& lab = std::nullopt)
      : id_(id), boot_id_(boot_id) {
    if (lab) key_ = node_key(*lab, id);
  }

  double offset_s = -86'400.0 + 5.0;  // the node's counter minus host_s
  double drift = 20e-6;
  bool narrow = false;
  std::uint16_t battery_mv = 0;
  std::vector<NodeSample> samples;

  std::uint64_t counter_us(HostTime t) const {
    const double s = seconds(t - host_s(0.0));
    const auto us = static_cast<std::uint64_t>((s * (1 + drift) + 86'400.0 + offset_s) * 1e6);
    return narrow ? us & 0xffff'ffffU : us;
  }
  void reboot(std::uint32_t boot_id, HostTime now) {
    boot_id_ = boot_id;
    sequence_ = 0;
    echo_.reset();
    offset_s = -86'400.0 - seconds(now - host_s(0.0));
  }
  void set_key(const LabKey& lab) { key_ = node_key(lab, id_); }
  void set_key(const MacKey& key) { key_ = key; }
  void drop_echo() { echo_.reset(); }
  std::optional<ReplyEcho>& echo() { return echo_; }
  std::uint32_t& sequence() { return sequence_; }

  Bytes frame(HostTime now) {
    NodeFrame frame;
    frame.origin = {id_, boot_id_, sequence_++};
    frame.n_tx_us = counter_us(now);
    frame.has_battery = battery_mv > 0;
    frame.battery_mv = battery_mv;
    frame.has_echo = echo_.has_value();
    if (echo_) frame.echo = *echo_;
    frame.sample_count = samples.size();
    std::copy(samples.begin(), samples.end(), frame.samples.begin());
    Bytes out(max_node_datagram);
    out.resize(encode(frame, key(), out).size());
    return out;
  }
  /// Whether the bytes are a reply for this node.
  bool take_reply(const Bytes& bytes, HostTime now) {
    Envelope envelope;
    NodeReply reply;
    if (open_envelope(bytes, envelope) != NodeRefusal::none) return false;
    if (decode(envelope, key(), reply) != NodeRefusal::none) return false;
    if (reply.origin.node_id != id_ || reply.origin.boot_id != boot_id_) return false;
    echo_ = {reply.reply_sequence, reply.nonce, counter_us(now)};
    locked = reply.locked;
    return true;
  }
  const MacKey* key() const { return key_ ? &*key_ : nullptr; }
  bool locked = false;

 private:
  std::uint32_t id_, boot_id_, sequence_ = 0;
  std::optional<MacKey> key_;
  std::optional<ReplyEcho> echo_;
};

/// NodeResponder with frames that arrive after a delay of `up`, and replies after a delay of
/// `down`.
struct TestDesk {
  explicit TestDesk(const std::optional<LabKey>& lab = std::nullopt) : responder({lab, secret}) {}

  NodeMessage take(const Bytes& bytes, const NodeAddress& from, HostTime at) {
    return responder.receive({bytes, from, at});
  }
  Bytes reply(HostTime at) {
    Bytes out(64);
    out.resize(responder.answer(at, out).size());
    return out;
  }
  /// Sends a frame at t, and gives the node its reply.
  NodeMessage exchange(TestNode& node, const NodeAddress& from, double t) {
    const NodeMessage message = take(node.frame(host_s(t)), from, host_s(t + 0.001));
    const Bytes answer = reply(host_s(t + 0.0011));
    if (!answer.empty()) node.take_reply(answer, host_s(t + 0.002));
    return message;
  }
  std::uint64_t count(NodeVerdict verdict) const { return responder.counts().verdicts[verdict]; }
  std::uint64_t count(NodeRefusal refusal) const { return responder.counts().refusals[refusal]; }
  std::uint64_t count(EchoVerdict verdict) const { return responder.counts().echoes[verdict]; }
  std::vector<NodeEvent::Kind> events() {
    std::vector<NodeEvent::Kind> kinds;
    for (const NodeEvent& event : responder.take_events()) kinds.push_back(event.kind);
    return kinds;
  }

  static constexpr SipHashKey secret{1, 2, 3};
  NodeResponder responder;
};

}  // namespace kinalign
