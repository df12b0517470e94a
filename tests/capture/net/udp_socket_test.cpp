// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/udp_socket.h"

#include "tests/capture/loopback.h"

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/capture/net/own_addresses.h"

#include <doctest/doctest.h>
#include <poll.h>

#include <cerrno>
#include <utility>

using namespace kinalign;

namespace {

std::string message(const Result<UdpSocket>& socket) {
  return socket ? "opened" : to_string(socket.error());
}

/// The first byte of each datagram that has come or comes within two seconds.
std::vector<int> first_bytes(DatagramBatch& batch, const UdpSocket& socket) {
  pollfd waiting{socket.fd(), POLLIN, 0};
  ::poll(&waiting, 1, 2000);
  std::vector<int> bytes;
  const std::size_t came = batch.receive(socket.fd());
  for (std::size_t i = 0; i < came; ++i) bytes.push_back(batch.at(i).bytes[0]);
  return bytes;
}

}  // namespace

TEST_CASE("an address is spelt in one way, and a name is none") {
  CHECK(spelt_address("0:0::1") == "::1");
  CHECK(spelt_address("::FFFF") == "::ffff");
  CHECK(spelt_address("0") == "0.0.0.0");
  CHECK(spelt_address("127.0.0.1") == "127.0.0.1");
  CHECK_FALSE(spelt_address("localhost"));
}

TEST_CASE("printed addresses are reachable ones, never the wildcard address") {
  using List = std::vector<std::string>;
  const List own{"192.168.7.1", "10.0.0.1", "fd00::1"};
  CHECK(reachable_at({}, own) == own);
  CHECK(reachable_at({"0.0.0.0"}, own) == List{"192.168.7.1", "10.0.0.1"});
  CHECK(reachable_at({"127.0.0.1", "::"}, own) == List{"127.0.0.1", "fd00::1"});
  CHECK(reachable_at({"::"}, {"192.168.7.1"}).empty());
}

TEST_CASE("port 0 is any free one, and a port that is taken is named") {
  const auto first = UdpSocket::open("127.0.0.1", 0);
  REQUIRE(first);
  CHECK(first->port() > 0);
  const std::string place = "127.0.0.1:" + std::to_string(first->port());
  CHECK(message(UdpSocket::open("127.0.0.1", first->port())) ==
        place + ": expected a UDP port to serve on, found a port that another program uses");
  CHECK(message(UdpSocket::open("127.0.0.2", first->port())) == "opened");
}

TEST_CASE("a port is free again once its socket is gone, or was moved over") {
  auto first = UdpSocket::open("127.0.0.1", 0);
  auto second = UdpSocket::open("127.0.0.1", 0);
  REQUIRE(first);
  REQUIRE(second);
  const std::uint16_t port = first->port();
  *first = std::move(*second);
  second = UdpSocket::open("127.0.0.2", 0);
  CHECK(message(UdpSocket::open("127.0.0.1", port)) == "opened");
}

TEST_CASE("a followed sender has a socket of its own, and no other program can use the port") {
  const Client friend_of_ours, stranger;
  for (const std::string here : {"127.0.0.1", "0.0.0.0"}) {
    CAPTURE(here);
    const auto open = UdpSocket::open(here, 0);
    REQUIRE(open);
    DatagramBatch batch;
    friend_of_ours.send("127.0.0.1", open->port(), {1});
    REQUIRE(first_bytes(batch, *open) == std::vector{1});
    const Datagram from = batch.at(0);
    const auto follow = [&] {
      return UdpSocket::connected(from.to, open->port(), from.from, from.from_port);
    };
    CHECK(message(follow()).ends_with(
        "expected a UDP socket of its own, found a port that another program uses"));
    REQUIRE(open->share_port());
    const auto line = follow();
    REQUIRE(line);
    CHECK_FALSE(UdpSocket::open(here, open->port()));
    friend_of_ours.send("127.0.0.1", open->port(), {2});
    stranger.send("127.0.0.1", open->port(), {3});
    CHECK(first_bytes(batch, *line) == std::vector{2});
    CHECK(first_bytes(batch, *open) == std::vector{3});
  }
}

TEST_CASE("an address that this host has not, or that is none, is named") {
  CHECK(message(UdpSocket::open("192.0.2.77", 0)) ==
        "192.0.2.77:0: expected a UDP port to serve on, found no network interface with this "
        "address");
  for (const std::string text : {"lab", "::1::", "1.2.3.4.5", ""}) {
    const std::string found = text.empty() ? "" : ", found " + text;
    CHECK(message(UdpSocket::open(text, 0)) == "expected an IPv4 or IPv6 address" + found);
  }
}

TEST_CASE("the obstacle to a port is stated in words and as the error's kind") {
  const auto said = [](int code, std::uint16_t port) {
    const Error error = no_port("127.0.0.1:80", "a UDP port", code, port);
    CHECK(error.file == "127.0.0.1:80");
    CHECK(error.expected == "a UDP port");
    return std::pair(error.kind, error.found);
  };
  using Said = std::pair<ErrorKind, std::string>;
  CHECK(said(EADDRINUSE, 80) == Said(ErrorKind::port_taken, "a port that another program uses"));
  CHECK(said(EACCES, 80) == Said(ErrorKind::port_forbidden, "no permission for a port below 1024"));
  CHECK(said(EPERM, 1024) == Said(ErrorKind::port_forbidden, "no permission"));
  CHECK(said(EADDRNOTAVAIL, 80) ==
        Said(ErrorKind::address_elsewhere, "no network interface with this address"));
  CHECK(said(EMFILE, 80) == Said(ErrorKind::other, "Too many open files"));
}

TEST_CASE("an IPv6 address stands in brackets before its port") {
  CHECK(endpoint_text("::1", 123) == "[::1]:123");
  CHECK(endpoint_text("127.0.0.1", 123) == "127.0.0.1:123");
}
