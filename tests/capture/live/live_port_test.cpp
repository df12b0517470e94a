// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/live/live_port.h"

#include "kinalign/mcap/reader.h"
#include "kinalign/recording/format.h"

#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <optional>

using namespace kinalign;

namespace {

Handle connected_to(std::uint16_t port) {
  Handle out(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(::connect(out.fd(), reinterpret_cast<sockaddr*>(&at), sizeof at) == 0);
  return out;
}

/// All bytes up to the end of the connection.
std::string all_from(const Handle& client) {
  std::string out;
  std::array<char, 1 << 16> room{};
  for (ssize_t got = 0; (got = ::recv(client.fd(), room.data(), room.size(), 0)) > 0;) {
    out.append(room.data(), static_cast<std::size_t>(got));
  }
  return out;
}

const McapChannel channel{1, 0, "/imu/1/raw", "", {}};

LivePort opened() {
  auto port = LivePort::open(0, {"kinalign", "test"}, {{"facts", {}}});
  REQUIRE(port);
  return *std::move(port);
}

}  // namespace

TEST_CASE("a client gets a stream that can be read as a file, with its end") {
  LivePort port = opened();
  const Handle client = connected_to(port.port());
  port.turn();
  REQUIRE(port.has_clients());
  for (std::uint32_t i = 0; i < 100; ++i) {
    port.add(nullptr, channel, {1, i, 1000 + i, 2000 + i, "abc"});
    port.turn();
  }
  port.end();
  McapReader reader;
  reader.feed(all_from(client));
  reader.end();
  std::uint32_t next = 0;
  while (const auto record = reader.next()) {
    const auto* message = std::get_if<McapMessage>(&*record);
    if (message != nullptr) CHECK(message->sequence == next++);
  }
  CHECK(next == 100);
  CHECK(reader.closed());
  CHECK(reader.findings().empty());
}

TEST_CASE("a client that does not read loses whole messages, which are counted, and nobody waits") {
  LivePort port = opened();
  const Handle stalled = connected_to(port.port());
  port.turn();
  const std::string data(1 << 16, 'x');
  constexpr std::uint32_t messages = 400;  // 25 MiB: more than the kernel and we keep
  for (std::uint32_t i = 0; i < messages; ++i) {
    port.add(nullptr, channel, {1, i, i, i, data});
    port.turn();
  }
  CHECK(port.counts().lost > 0);
  CHECK(port.counts().lost < messages);
  port.end();
  McapReader reader;
  reader.feed(all_from(stalled));
  reader.end();
  std::uint64_t got = 0;
  while (const auto record = reader.next()) {
    if (const auto* message = std::get_if<McapMessage>(&*record)) {
      ++got;
      CHECK(message->data == data);
    }
  }
  CHECK(got + port.counts().lost <= messages);
}

TEST_CASE("a client that says something, and one too many, are turned away") {
  LivePort port = opened();
  std::vector<Handle> clients;
  for (std::size_t i = 0; i < LivePort::most_clients; ++i) {
    clients.push_back(connected_to(port.port()));
  }
  port.turn();
  CHECK(port.counts().clients == LivePort::most_clients);
  const Handle further = connected_to(port.port());
  port.turn();
  CHECK(port.counts().turned_away == 1);
  CHECK(all_from(further).empty());
  REQUIRE(::send(clients.front().fd(), "GET", 3, 0) == 3);
  port.turn();
  CHECK(port.counts().turned_away == 2);
  clients.clear();
  port.turn();
  CHECK(!port.has_clients());
}
