// SPDX-License-Identifier: Apache-2.0
// A client's socket on loopback, for tests of servers.
#pragma once

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Whether ::1 is an address of this host.
inline bool has_ipv6_loopback() {
  sockaddr_in6 address{};
  address.sin6_family = AF_INET6;
  address.sin6_addr = in6addr_loopback;
  const int fd = ::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool bound =
      fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (fd >= 0) ::close(fd);
  return bound;
}

/// A datagram that came, and the address of its sender: "127.0.0.5".
struct Came {
  std::vector<std::uint8_t> bytes;
  std::string from;
};

class Client {
 public:
  explicit Client(int family = AF_INET) : fd_(::socket(family, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    REQUIRE(fd_ >= 0);
    const timeval patience{2, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    const int may = 1;
    ::setsockopt(fd_, SOL_SOCKET, SO_BROADCAST, &may, sizeof may);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { ::close(fd_); }

  void send(const std::string& to, std::uint16_t port,
            const std::vector<std::uint8_t>& bytes) const {
    sockaddr_in four{};
    sockaddr_in6 six{};
    four.sin_family = AF_INET;
    six.sin6_family = AF_INET6;
    four.sin_port = six.sin6_port = htons(port);
    const bool is_four = ::inet_pton(AF_INET, to.c_str(), &four.sin_addr) == 1;
    if (!is_four) REQUIRE(::inet_pton(AF_INET6, to.c_str(), &six.sin6_addr) == 1);
    const auto* address = is_four ? reinterpret_cast<const sockaddr*>(&four)
                                  : reinterpret_cast<const sockaddr*>(&six);
    const auto size = static_cast<socklen_t>(is_four ? sizeof four : sizeof six);
    REQUIRE(::sendto(fd_, bytes.data(), bytes.size(), 0, address, size) ==
            static_cast<ssize_t>(bytes.size()));
  }

  /// The next datagram; nothing if none came in two seconds.
  std::optional<Came> receive() const {
    std::vector<std::uint8_t> bytes(2048);
    sockaddr_in6 from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        ::recvfrom(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0) return std::nullopt;
    bytes.resize(static_cast<std::size_t>(got));
    std::array<char, INET6_ADDRSTRLEN> text{};
    const auto* four = reinterpret_cast<const sockaddr_in*>(&from);
    const bool six = from.sin6_family == AF_INET6;
    const void* address = six ? static_cast<const void*>(&from.sin6_addr) : &four->sin_addr;
    ::inet_ntop(from.sin6_family, address, text.data(), text.size());
    return Came{bytes, text.data()};
  }

 private:
  int fd_;
};

}  // namespace kinalign
