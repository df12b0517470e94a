// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/host_address.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

HostAddress address(const std::string& text) {
  const auto network = parse_network(text);
  REQUIRE(network);
  return network->prefix;
}

bool has(const std::string& network, const std::string& one) {
  const auto parsed = parse_network(network);
  REQUIRE(parsed);
  return parsed->has(address(one));
}

bool one_stranger(const std::string& a, const std::string& b) {
  const HostAddress first = address(a), second = address(b);
  const auto x = address_prefix(first), y = address_prefix(second);
  return std::equal(x.begin(), x.end(), y.begin());
}

}  // namespace

TEST_CASE("a network has the addresses that begin as it does") {
  CHECK(has("192.168.7.0/24", "192.168.7.255"));
  CHECK(!has("192.168.7.0/24", "192.168.8.0"));
  CHECK(has("10.0.0.0/9", "10.127.0.1"));
  CHECK(!has("10.0.0.0/9", "10.128.0.1"));
  CHECK(has("0.0.0.0/0", "203.0.113.9"));
  CHECK(!has("0.0.0.0/0", "::1"));
  CHECK(has("fd00::/8", "fdff::1"));
  CHECK(!has("fd00::/8", "fe80::1"));
  CHECK(has("::1", "::1"));
  CHECK(!has("::1", "::2"));
  CHECK(has("::/0", "203.0.113.9"));
}

TEST_CASE("a text that is not a network is refused and shown") {
  for (const std::string text : {"", "lab", "192.168.7", "192.168.7.0/33", "::1/129", "1.2.3.4/",
                                 "1.2.3.4/x", "1.2.3.4/-1", "1.2.3.4/8 ", "fd00::/8/8"}) {
    const auto network = parse_network(text);
    REQUIRE(!network);
    CHECK(to_string(network.error()) == "expected an address or a network, such as 192.168.7.0/24" +
                                            (text.empty() ? "" : ", found " + text));
  }
}

TEST_CASE("one unknown client is an IPv4 address, or an IPv6 network of 64 bits") {
  CHECK(one_stranger("192.0.2.1", "192.0.2.1"));
  CHECK(!one_stranger("192.0.2.1", "192.0.2.2"));
  CHECK(one_stranger("2001:db8::1", "2001:db8::ffff:0:0:9"));
  CHECK(!one_stranger("2001:db8::1", "2001:db8:0:1::1"));
}
