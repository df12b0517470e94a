// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_lines.h"

#include "tests/capture/loopback.h"

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/wire/node_frame.h"

#include <doctest/doctest.h>
#include <poll.h>

#include <string>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

/// One node, a server that accepts all nodes, and the datagrams that come.
struct Server {
  std::vector<UdpSocket> open;
  NodeLines lines;
  Client node;
  DatagramBatch batch;

  Server() : open(opened()), lines(open, 1) {}
  static std::vector<UdpSocket> opened() {
    std::vector<UdpSocket> sockets;
    sockets.push_back(UdpSocket::open("0.0.0.0", 0).value());
    return sockets;
  }
  /// The shortest datagram that the kernel's filter lets through.
  static std::vector<std::uint8_t> frame() {
    std::vector<std::uint8_t> bytes(max_node_datagram);
    bytes.resize(encode(NodeFrame{}, nullptr, bytes).size());
    return bytes;
  }
  struct Arrival {
    NodeLines::Way way;
    bool over_a_line = false;
  };
  /// Sends one frame of the node to that address, and gives it as it arrives.
  Arrival sent_to(const std::string& host) {
    node.send(host, open[0].port(), frame());
    pollfd waiting{lines.fd(), POLLIN, 0};
    ::poll(&waiting, 1, 2000);
    const auto ready = lines.ready();
    REQUIRE(ready.size() == 1);
    REQUIRE(batch.receive(ready[0]->fd()) == 1);
    const Datagram datagram = batch.at(0);
    return {{{datagram.from, datagram.from_port}, datagram.to}, ready[0] != &open[0]};
  }
  void follow(const NodeLines::Way& way, HostTime now) {
    lines.follow(0, way, open[0].port(), now);
  }
};

}  // namespace

TEST_CASE("a node that is followed has a line to the address that it sends to") {
  Server server;
  const auto came = server.sent_to("127.0.0.1");
  CHECK(!came.over_a_line);
  server.follow(came.way, HostTime{10s});
  CHECK(server.sent_to("127.0.0.1").over_a_line);
  CHECK(!server.sent_to("127.0.0.2").over_a_line);
}

TEST_CASE("one that sends to two addresses in turn has its line moved once a second") {
  Server server;
  const auto one = server.sent_to("127.0.0.1").way, other = server.sent_to("127.0.0.2").way;
  server.follow(one, HostTime{10s});
  for (HostTime now{10s}; now < HostTime{10s + 990ms}; now += 10ms) {
    server.follow(other, now);
    server.follow(one, now);
  }
  CHECK(server.sent_to("127.0.0.1").over_a_line);
  server.follow(other, HostTime{11s});
  CHECK(server.sent_to("127.0.0.2").over_a_line);
  CHECK(!server.sent_to("127.0.0.1").over_a_line);
}

TEST_CASE("if no socket is available, the next attempt is a second later") {
  Server server;
  const auto way = server.sent_to("127.0.0.1").way;
  auto nowhere = way;
  nowhere.to[12] = 192;  // 192.0.0.1 is no address of this host
  server.follow(nowhere, HostTime{10s});
  CHECK(!server.sent_to("127.0.0.1").over_a_line);
  server.follow(way, HostTime{10s + 500ms});
  CHECK(!server.sent_to("127.0.0.1").over_a_line);
  server.follow(way, HostTime{11s});
  CHECK(server.sent_to("127.0.0.1").over_a_line);
}
