// SPDX-License-Identifier: Apache-2.0
// A flood on loopback, run by node_flood.py and by a short test: from 10,000 source addresses
// (127.1.x.y), in turn rubbish, well-formed frames of strangers and frames of known nodes with
// wrong MACs at the nodes' port, requests and rubbish at the NTP port.
//   node_flood NODE_PORT NTP_PORT PACKETS_PER_S SECONDS      (at most 200,000 and 60)
// Prints how many it sent, of each kind, as JSON.
#include "kinalign/wire/node_frame.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

namespace {

using namespace kinalign;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t addresses = 10'000, known_nodes = 5;
constexpr std::size_t batch = 32;

using Bytes = std::vector<std::uint8_t>;

Bytes frame(std::uint32_t id, std::uint32_t number, const MacKey* key) {
  NodeFrame frame;
  frame.origin = {id, 7 * number, number};
  frame.n_tx_us = 1000 * number;
  frame.sample_count = 1;
  Bytes out(max_node_datagram);
  out.resize(encode(frame, key, out).size());
  return out;
}

enum Kind : std::size_t { rubbish, stranger, spoofed, request, kinds };

Bytes packet(Kind kind, std::uint32_t number) {
  constexpr MacKey wrong{0xba, 0xd};
  if (kind == stranger) return frame(1000 + number, number, nullptr);
  if (kind == spoofed) return frame(1 + number % known_nodes, number, &wrong);
  Bytes bytes(kind == request ? 48 : 30 + number % 1000, static_cast<std::uint8_t>(number));
  if (kind == request) bytes[0] = 0x23;
  return bytes;
}

struct Message {
  iovec part{};
  sockaddr_in to{};
  alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(sizeof(in_pktinfo))> control{};
  Bytes bytes;

  void aim(std::uint16_t port, std::uint32_t source) {
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    cmsghdr head{};
    head.cmsg_level = IPPROTO_IP;
    head.cmsg_type = IP_PKTINFO;
    head.cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
    in_pktinfo info{};
    info.ipi_spec_dst.s_addr = htonl(0x7f010000U + 1 + source);
    std::memcpy(control.data(), &head, sizeof head);
    std::memcpy(control.data() + CMSG_LEN(0), &info, sizeof info);
  }
  msghdr head() {
    part = {bytes.data(), bytes.size()};
    msghdr made{};
    made.msg_name = &to;
    made.msg_namelen = sizeof to;
    made.msg_iov = &part;
    made.msg_iovlen = 1;
    made.msg_control = control.data();
    made.msg_controllen = control.size();
    return made;
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto port = [&](int i) { return static_cast<std::uint16_t>(std::atoi(argv[i])); };
  const double rate = std::clamp(std::atof(argv[3]), 1.0, 200'000.0);
  const double length_s = std::clamp(std::atof(argv[4]), 0.0, 60.0);
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::array<Message, batch> messages;
  std::array<mmsghdr, batch> heads{};
  std::array<std::uint64_t, kinds> sent{};
  const auto begin = Clock::now();
  std::uint32_t number = 0;
  for (double s = 0; s < length_s;
       s = std::chrono::duration<double>(Clock::now() - begin).count()) {
    if (number > rate * s) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      continue;
    }
    for (std::size_t i = 0; i < batch; ++i, ++number) {
      const auto kind = static_cast<Kind>(number % kinds);
      const bool ntp = kind == request || (kind == rubbish && number % 8 == 0);
      messages[i].bytes = packet(kind, number);
      messages[i].aim(ntp ? port(2) : port(1), number % addresses);
      heads[i].msg_hdr = messages[i].head();
      ++sent[kind];
    }
    ::sendmmsg(fd, heads.data(), batch, 0);
  }
  ::close(fd);
  std::printf(
      "{\"rubbish\": %lu, \"strangers\": %lu, \"spoofed\": %lu, \"requests\": %lu, \"seconds\": "
      "%.3f}\n",
      sent[rubbish], sent[stranger], sent[spoofed], sent[request],
      std::chrono::duration<double>(Clock::now() - begin).count());
  return 0;
}
