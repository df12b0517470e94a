// SPDX-License-Identifier: Apache-2.0
// Two hosts and one tracker that is never silent. Both hosts must give the tracker the same
// verdicts, although one of them also receives datagrams of other addresses, some with the
// tracker's MAC. No address may get more bytes than it sent.
#include "kinalign/capture/recorder/slimevr_responder.h"
#include "kinalign/wire/bytes.h"

#include <cstdlib>
#include <map>
#include <memory>

using namespace kinalign;

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t own = 0;

NodeAddress address(std::uint8_t last) {
  NodeAddress at;
  at.host = mapped_ipv4(std::array<std::uint8_t, 4>{10, 0, 0, last});
  at.port = 6969;
  return at;
}

/// A packet with the head of its type and number, and with the body `rest`.
Bytes packet(std::uint8_t type, std::uint64_t number, std::span<const std::uint8_t> rest) {
  Bytes bytes(12 + rest.size());
  ByteWriter writer(bytes);
  writer.put(std::uint32_t{type});
  writer.put(number);
  std::copy(rest.begin(), rest.end(), bytes.begin() + 12);
  return bytes;
}

/// A handshake that ends with the MAC address; the last byte of that is `name`.
Bytes handshake(std::uint8_t name) {
  Bytes body(28 + 1 + 6);
  body[28 + 6] = name;
  return packet(3, 0, body);
}

class Host {
 public:
  SlimeResult receive(std::uint8_t from, const Bytes& bytes, HostTime now) {
    received_[from] += bytes.size();
    const SlimeResult result = responder_.receive({bytes, address(from), now});
    settle();
    return result;
  }
  void tick(HostTime now) {
    responder_.tick(now);
    settle();
  }

 private:
  void settle() {
    for (const auto& one : responder_.take_sendings()) {
      const std::uint8_t to = one.to.host[15];
      sent_[to] += one.answer.size;
      if (sent_[to] > received_[to]) std::abort();
    }
  }
  SlimeResponder responder_{SipHashKey{7}};
  std::map<std::uint8_t, std::size_t> received_, sent_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto quiet = std::make_unique<Host>(), noisy = std::make_unique<Host>();
  HostTime now{std::chrono::hours(1)};
  std::uint64_t number = 0;
  quiet->receive(own, handshake(1), now);
  noisy->receive(own, handshake(1), now);
  ByteReader reader({data, size});
  while (reader.left() > 4) {
    const auto how = reader.take<std::uint8_t>(), from = reader.take<std::uint8_t>();
    const auto type = reader.take<std::uint8_t>();
    const std::size_t length = std::min<std::size_t>(reader.take<std::uint8_t>(), reader.left());
    const std::span<const std::uint8_t> rest(data + size - reader.left(), length);
    for (std::size_t i = 0; i < length; ++i) reader.take<std::uint8_t>();
    now += std::chrono::milliseconds(4 * (how % 64));
    Bytes bytes = how >= 192 ? handshake(type % 4) : packet(type, how, rest);
    if (how % 5 == 0) bytes.assign(rest.begin(), rest.end());
    if (from != own) noisy->receive(from, bytes, now);
    const Bytes mine = packet(type % 2 == 0 ? 17 : 23, ++number, rest);
    if (quiet->receive(own, mine, now).verdict != noisy->receive(own, mine, now).verdict)
      std::abort();
    if (how % 3 != 0) continue;
    quiet->tick(now);
    noisy->tick(now);
  }
  return 0;
}
