// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/live_socket.h"

#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

using namespace kinalign;

namespace {

constexpr std::array<std::uint8_t, 3> datagram{1, 2, 3};

/// A loopback port on which a server listens as long as this exists.
class Listener {
 public:
  Listener() : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(::bind(fd_, reinterpret_cast<sockaddr*>(&address), size) == 0);
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener() { ::close(fd_); }

  std::uint16_t port() const { return port_; }
  /// Sends each datagram back.
  void answer() const {
    std::array<std::uint8_t, 16> room{};
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        ::recvfrom(fd_, room.data(), room.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    REQUIRE(got > 0);
    REQUIRE(::sendto(fd_, room.data(), static_cast<std::size_t>(got), 0,
                     reinterpret_cast<sockaddr*>(&from), size) == got);
  }

 private:
  int fd_;
  std::uint16_t port_ = 0;
};

LiveSocket opened(std::uint16_t port) {
  auto socket = LiveSocket::connected_to("127.0.0.1", port);
  REQUIRE(socket);
  return *std::move(socket);
}

std::uint16_t port_of_nobody() { return Listener().port(); }

}  // namespace

TEST_CASE("every datagram to a closed port is counted, also for a device that receives") {
  for (const bool hears : {false, true}) {
    CAPTURE(hears);
    LiveSocket socket = opened(port_of_nobody());
    std::array<std::uint8_t, 16> room{};
    for (int i = 0; i < 5; ++i) {
      CHECK(socket.send(datagram));
      if (hears) CHECK(socket.receive(room) == 0);
    }
    CHECK(socket.traffic().sent == 5);
    CHECK(socket.traffic().refused == 5);
    CHECK(socket.traffic().received == 0);
  }
}

TEST_CASE("what is taken is not counted as refused, and what comes back is counted") {
  const Listener listener;
  LiveSocket socket = opened(listener.port());
  std::array<std::uint8_t, 16> room{};
  for (int i = 0; i < 3; ++i) {
    CHECK(socket.send(datagram));
    listener.answer();
    CHECK(socket.receive(room) == datagram.size());
  }
  CHECK(socket.receive(room) == 0);
  CHECK(socket.traffic().sent == 3);
  CHECK(socket.traffic().refused == 0);
  CHECK(socket.traffic().received == 3);
}

TEST_CASE("a host is named by an address of either kind, never by a name") {
  for (const char* host : {"127.0.0.1", "::1", "10.9.9.9"}) CHECK(check_live_address(host));
  for (const char* host : {"localhost", "127.0.0.1:7012", "lab host"}) {
    CAPTURE(host);
    const auto refused = check_live_address(host);
    REQUIRE(!refused);
    CHECK(to_string(refused.error()) ==
          "--to: expected an address in numbers, such as 127.0.0.1, found " + shown(host));
  }
}
