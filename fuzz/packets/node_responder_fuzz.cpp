// SPDX-License-Identifier: Apache-2.0
// Two hosts, one authenticated node: its messages bring the same, whether or not others send
// anything in between, with MACs that are right for other nodes or for none. No sender gets more
// bytes than it sent.
#include "fuzz/packets/node_datagrams.h"

#include "kinalign/capture/nodes/node_responder.h"
#include "kinalign/wire/bytes.h"
#include "kinalign/wire/node_reply.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

using namespace kinalign;

namespace {

constexpr std::uint32_t own_id = 7;
constexpr LabKey lab{1, 2, 3};
constexpr std::array<std::uint8_t, 4> own_host{10, 0, 0, 1};

using Out = std::array<std::uint8_t, max_node_datagram>;

NodeResponderOptions responder_options() {
  NodeResponderOptions options;
  options.lab_key = lab;
  return options;
}

NodeAddress own_address() {
  NodeAddress address;
  address.host = mapped_ipv4(own_host);
  address.port = 4000;
  return address;
}

/// The node, and the NodeResponder of one of the hosts.
class Pair {
 public:
  /// Sends a frame to the host and its reply to the node; gives the exchange that resulted.
  std::optional<Exchange> exchange(HostTime now) {
    NodeFrame frame;
    frame.origin = {own_id, 1, sequence_++};
    frame.n_tx_us = static_cast<std::uint64_t>(now.time_since_epoch().count() / 1000);
    frame.has_echo = echo_.has_value();
    if (echo_) frame.echo = *echo_;
    Out out{};
    const MacKey key = node_key(lab, own_id);
    const NodeMessage message = responder.receive({encode(frame, &key, out), from, now});
    Envelope envelope;
    NodeReply reply;
    const auto answer = responder.answer(now, out);
    if (open_envelope(answer, envelope) == NodeRefusal::none &&
        decode(envelope, &key, reply) == NodeRefusal::none) {
      echo_ = {reply.reply_sequence, reply.nonce, frame.n_tx_us};
    }
    return message.exchange;
  }
  NodeResponder responder{responder_options()};
  NodeAddress from = own_address();

 private:
  std::uint32_t sequence_ = 0;
  std::optional<ReplyEcho> echo_;
};

bool same(const std::optional<Exchange>& a, const std::optional<Exchange>& b) {
  if (!a || !b) return !a && !b;
  if (a->boot != b->boot || a->n_tx != b->n_tx || a->h_rx != b->h_rx) return false;
  if (!a->echo || !b->echo) return !a->echo && !b->echo;
  return a->echo->n_rx == b->echo->n_rx && a->echo->h_tx == b->echo->h_tx;
}

/// Bytes of the input as a datagram: unchanged, repaired, or repaired with the MAC of node 8.
std::vector<std::uint8_t> datagram_of(std::span<const std::uint8_t> bytes, std::uint8_t how) {
  std::vector<std::uint8_t> datagram(bytes.begin(), bytes.end());
  const MacKey key = node_key(lab, 8);
  if (how % 4 == 0 || datagram.size() < 12) return datagram;
  if (how % 4 == 2) ByteWriter(std::span(datagram).subspan(8)).put(std::uint32_t{8});
  mend(datagram, static_cast<DatagramType>(1 + how / 4 % 5), how % 4 == 1 ? nullptr : &key);
  return datagram;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto quiet = std::make_unique<Pair>(), noisy = std::make_unique<Pair>();
  ByteReader reader({data, size});
  HostTime now{std::chrono::hours(1)};
  while (reader.left() > 4) {
    const auto how = reader.take<std::uint8_t>();
    const auto last = reader.take<std::uint8_t>();
    now += std::chrono::milliseconds(reader.take<std::uint8_t>());
    const std::size_t length = std::min<std::size_t>(reader.take<std::uint8_t>(), reader.left());
    const auto bytes = datagram_of({data + size - reader.left(), length}, how);
    for (std::size_t i = 0; i < length; ++i) reader.take<std::uint8_t>();
    NodeAddress from = noisy->from;  // sometimes the node's own address
    from.host[15] = last;
    const NodeMessage message = noisy->responder.receive({bytes, from, now});
    if (message.exchange && (message.exchange->boot == 1 && how % 4 != 2)) std::abort();
    Out out{};
    if (noisy->responder.answer(now, out).size() > bytes.size()) std::abort();
    if (how < 128) continue;
    if (!same(quiet->exchange(now), noisy->exchange(now))) std::abort();
  }
  return 0;
}
