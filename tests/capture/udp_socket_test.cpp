// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/udp_socket.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::string message(const Result<UdpSocket>& socket) {
  return socket ? "opened" : to_string(socket.error());
}

}  // namespace

TEST_CASE("port 0 is any free one, and a port that is taken is named") {
  const auto first = UdpSocket::open("127.0.0.1", 0);
  REQUIRE(first);
  CHECK(first->port() > 0);
  const std::string place = "127.0.0.1:" + std::to_string(first->port());
  CHECK(message(UdpSocket::open("127.0.0.1", first->port())) ==
        place + ": expected a UDP port to serve on, found another program on it");
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

TEST_CASE("an address that this host has not, or that is none, is named") {
  CHECK(message(UdpSocket::open("192.0.2.77", 0)) ==
        "192.0.2.77:0: expected a UDP port to serve on, found no interface that has it");
  for (const std::string text : {"lab", "::1::", "1.2.3.4.5", ""}) {
    const std::string found = text.empty() ? "" : ", found " + text;
    CHECK(message(UdpSocket::open(text, 0)) == "expected an IPv4 or IPv6 address" + found);
  }
}

TEST_CASE("an IPv6 address stands in brackets before its port") {
  CHECK(endpoint_text("::1", 123) == "[::1]:123");
  CHECK(endpoint_text("127.0.0.1", 123) == "127.0.0.1:123");
}
