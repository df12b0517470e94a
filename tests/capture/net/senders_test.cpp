// SPDX-License-Identifier: Apache-2.0
// Which senders get a number on a port when there are many: strangers, forged addresses, and
// earlier sessions of a device.
#include "kinalign/capture/net/pieces.h"

#include <doctest/doctest.h>

#include <array>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

HostAddress host(std::uint8_t high, std::uint8_t low) {
  return mapped_ipv4(std::array<std::uint8_t, 4>{10, 0, high, low});
}

constexpr HostTime begin{100s};

}  // namespace

TEST_CASE("a sender keeps its number and its serial while it sends") {
  Senders senders;
  CHECK(senders.number(host(0, 1), 7, begin) == 0);
  CHECK(senders.number(host(0, 1), 8, begin) == 1);
  CHECK(senders.number(host(0, 1), 7, begin + 1h) == 0);
  CHECK(senders.at(0).serial == 1);
  CHECK(senders.at(1).serial == 2);
  CHECK(senders.find(host(0, 2), 7) == std::nullopt);
}

TEST_CASE("a device that comes late gets its place although forged senders come ten a second") {
  Senders senders;
  const HostAddress device = host(1, 1);
  std::optional<std::size_t> number;
  HostTime now = begin;
  for (int k = 0; k < 64 + 128; ++k) {
    now = begin + k * 100ms;
    CHECK(senders.number(host(2, static_cast<std::uint8_t>(k)), 9, now));
    if (k >= 64) number = senders.number(device, 7, now + 50ms);
    if (k >= 64) CHECK(number);
  }
  CHECK(senders.at(*number).host == device);
}

TEST_CASE("a sender of many messages keeps its place for a minute of silence, and newcomers wait") {
  Senders senders;
  for (std::uint8_t k = 0; k < Senders::most; ++k) {
    for (int i = 0; i < 10; ++i) CHECK(senders.number(host(0, k), 7, begin + i * 1ms));
  }
  CHECK(!senders.number(host(1, 1), 7, begin + 59s));
  // It takes the place of the first sender, which was silent longest.
  CHECK(senders.number(host(1, 1), 7, begin + 61s) == 0);
}

TEST_CASE("a device that returned 64 times within a minute is not locked out by its own past") {
  Senders senders;
  for (std::uint16_t k = 0; k < 200; ++k) {
    for (int i = 0; i < 10; ++i) {
      CHECK(senders.number(host(0, 1), k, begin + k * 500ms + i * 10ms));
    }
  }
}

TEST_CASE("after 1000 serials a device continues an earlier one, and unknown senders share one") {
  Senders senders;
  const HostAddress device = host(0, 1);
  for (std::uint16_t k = 0; k < 3000; ++k) {
    const auto number = senders.number(device, k, begin + k * 28s);
    REQUIRE(number);
    CHECK(senders.at(*number).host == device);
    CHECK(senders.at(*number).port == k);
    CHECK(senders.at(*number).serial <= Senders::most_serials);
  }
  const HostTime later = begin + 3000 * 28s;
  for (const std::uint8_t stranger : std::array<std::uint8_t, 2>{1, 2}) {
    const auto number = senders.number(host(3, stranger), 7, later);
    REQUIRE(number);
    CHECK(senders.at(*number).serial == Senders::most_serials + 1);
    CHECK(senders.number(host(3, stranger), 8, later + 1s) == number);
  }
}

TEST_CASE("a sender with a new port for each frame loses none, and displaces no other sender") {
  Senders senders;
  const HostAddress device = host(0, 1), other = host(0, 2);
  REQUIRE(senders.number(other, 7, begin) == 0);
  for (std::uint16_t k = 0; k < 5000; ++k) {
    const HostTime now = begin + k * 8ms;
    const auto number = senders.number(device, k, now);
    REQUIRE(number);
    CHECK(senders.at(*number).port == k);
    if (k % 200 == 0) CHECK(senders.number(other, 7, now) == 0);
  }
}
