// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/datagram_batch.h"

#include "tests/capture/loopback.h"

#include "kinalign/capture/net/udp_socket.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <ctime>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

UdpSocket socket_on(const std::string& address) {
  auto socket = UdpSocket::open(address, 0);
  REQUIRE(socket);
  return std::move(*socket);
}

Time now() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return Time{std::chrono::seconds(now.tv_sec) + Duration{now.tv_nsec}};
}

/// Sends back the first 64 bytes of each datagram.
void echo(DatagramBatch& batch, const UdpSocket& socket, std::size_t datagrams) {
  for (std::size_t i = 0; i < datagrams; ++i) {
    const Datagram asked = batch.at(i);
    const std::size_t size = std::min(asked.bytes.size(), DatagramBatch::answer_room);
    std::copy_n(asked.bytes.begin(), size, batch.answer_to(i).begin());
    batch.queue(i, asked, size);
  }
  CHECK(batch.send(socket.fd()).empty());
}

}  // namespace

TEST_CASE("a datagram comes with its bytes, both addresses and the kernel's stamp") {
  const UdpSocket socket = socket_on("0.0.0.0");
  const Client client;
  DatagramBatch batch;
  CHECK(batch.receive(socket.fd()) == 0);
  const Time before = now();
  client.send("127.0.0.5", socket.port(), {1, 2, 3});
  REQUIRE(batch.receive(socket.fd()) == 1);
  const Datagram datagram = batch.at(0);
  CHECK(std::vector(datagram.bytes.begin(), datagram.bytes.end()) ==
        std::vector<std::uint8_t>{1, 2, 3});
  CHECK(!datagram.cut);
  CHECK(datagram.from == HostAddress{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 127, 0, 0, 1});
  CHECK(datagram.to == HostAddress{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 127, 0, 0, 5});
  CHECK(datagram.from_port > 0);
  CHECK(datagram.unicast);
  REQUIRE(datagram.received);
  CHECK(*datagram.received >= before);
  CHECK(*datagram.received <= now());
}

TEST_CASE("an answer comes from the address that was asked") {
  const UdpSocket socket = socket_on("0.0.0.0");
  const Client client;
  DatagramBatch batch;
  for (const std::string to : {"127.0.0.5", "127.9.8.7", "127.0.0.1"}) {
    client.send(to, socket.port(), {9});
    REQUIRE(batch.receive(socket.fd()) == 1);
    echo(batch, socket, 1);
    const auto came = client.receive();
    REQUIRE(came);
    CHECK(came->from == to);
    CHECK(came->bytes == std::vector<std::uint8_t>{9});
  }
}

TEST_CASE("ipv6: a datagram and its answer" * doctest::skip(!has_ipv6_loopback())) {
  const UdpSocket socket = socket_on("::");
  const Client client(AF_INET6);
  DatagramBatch batch;
  client.send("::1", socket.port(), {4, 5});
  REQUIRE(batch.receive(socket.fd()) == 1);
  CHECK(batch.at(0).to == HostAddress{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1});
  CHECK(batch.at(0).from == batch.at(0).to);
  CHECK(batch.at(0).unicast);
  CHECK(batch.at(0).received);
  echo(batch, socket, 1);
  const auto came = client.receive();
  REQUIRE(came);
  CHECK(came->from == "::1");
}

TEST_CASE("a batch is at most 32, the rest waits, and each is answered once") {
  const UdpSocket socket = socket_on("127.0.0.1");
  const Client client;
  for (std::uint8_t i = 0; i < 40; ++i) client.send("127.0.0.1", socket.port(), {i});
  DatagramBatch batch;
  for (const std::size_t datagrams : {32U, 8U}) {
    REQUIRE(batch.receive(socket.fd()) == datagrams);
    echo(batch, socket, datagrams);
  }
  CHECK(batch.receive(socket.fd()) == 0);
  for (std::uint8_t i = 0; i < 40; ++i) {
    const auto came = client.receive();
    REQUIRE(came);
    CHECK(came->bytes == std::vector<std::uint8_t>{i});
  }
}

TEST_CASE("fault 26 long: what is longer than the room is marked as cut") {
  const UdpSocket socket = socket_on("127.0.0.1");
  const Client client;
  DatagramBatch batch;
  for (const std::size_t size :
       {DatagramBatch::room, DatagramBatch::room + 1, std::size_t{65'507}}) {
    client.send("127.0.0.1", socket.port(), std::vector<std::uint8_t>(size));
    REQUIRE(batch.receive(socket.fd()) == 1);
    CHECK(batch.at(0).cut == (size > DatagramBatch::room));
    CHECK(batch.at(0).bytes.size() == std::min(size, DatagramBatch::room));
  }
}

TEST_CASE("an answer that can't be sent is named and the others go") {
  const UdpSocket socket = socket_on("0.0.0.0");
  const Client client;
  for (std::uint8_t i = 0; i < 3; ++i) client.send("127.0.0.1", socket.port(), {i});
  DatagramBatch batch;
  REQUIRE(batch.receive(socket.fd()) == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    Datagram asked = batch.at(i);
    // An address that is not this host's: the system refuses to send from it.
    if (i == 1) asked.to[12] = 203;
    batch.answer_to(i)[0] = asked.bytes[0];
    batch.queue(i, asked, 1);
  }
  const auto unsent = batch.send(socket.fd());
  REQUIRE(unsent.size() == 1);
  CHECK(unsent[0] == 1);
  CHECK(client.receive()->bytes[0] == 0);
  CHECK(client.receive()->bytes[0] == 2);
}

TEST_CASE("no answer blocks: a client that reads nothing does not stop the server") {
  const UdpSocket socket = socket_on("127.0.0.1");
  const Client client;
  DatagramBatch batch;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 3000; ++i) {
    client.send("127.0.0.1", socket.port(), std::vector<std::uint8_t>(48));
    const std::size_t datagrams = batch.receive(socket.fd());
    for (std::size_t k = 0; k < datagrams; ++k) batch.queue(k, batch.at(k), 48);
    (void)batch.send(socket.fd());
  }
  CHECK(std::chrono::steady_clock::now() - begin < 30s);
}
