// SPDX-License-Identifier: Apache-2.0
// A UDP socket of a server: bound, never blocking, with the kernel's stamp of each arrival
// (CLOCK_REALTIME) and the address that it was sent to.
#pragma once

#include "kinalign/capture/net/host_address.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct sockaddr;  // <sys/socket.h>

namespace kinalign {

/// A port that could not be opened: what stands in the way, in words and as the error's kind.
/// `at`: the address and port. `code`: errno.
Error no_port(std::string at, std::string expected, int code, std::uint16_t port);

class UdpSocket {
 public:
  /// `address`: IPv4 or IPv6, with %interface where it is link-local; "0.0.0.0" and "::" are all of
  /// their kind. Port 0: any free one.
  static Result<UdpSocket> open(const std::string& address, std::uint16_t port);
  /// For what `peer` alone sends to `own`, beside an open one of the same port that shares it.
  static Result<UdpSocket> connected(const HostAddress& own, std::uint16_t port,
                                     const HostAddress& peer, std::uint16_t peer_port);
  /// From now on sockets of this user, and of nobody else, may be bound to the same port if they
  /// share it too, which `open` does not: a second server is still refused. Not before it is bound
  /// itself, so that it is refused likewise.
  bool share_port() const;

  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&& other) noexcept;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  ~UdpSocket();

  int fd() const { return fd_; }
  std::uint16_t port() const { return port_; }
  const std::string& address() const { return address_; }

 private:
  UdpSocket(int fd, std::string address) : fd_(fd), address_(std::move(address)) {}

  int fd_ = -1;
  std::uint16_t port_ = 0;
  std::string address_;
};

/// Datagrams that the kernel dropped: filtered, or without room in the buffer.
std::uint64_t dropped_by_kernel(const UdpSocket& socket);

/// An address that open takes, as the system writes it: "0.0.0.0" of "0". Absent: it is none, or a
/// name, which might be several.
std::optional<std::string> spelt_address(const std::string& text);
std::string address_text(const sockaddr& address);

/// Whether `address`, as the system writes it, stands for all of its kind.
inline bool is_any_address(std::string_view address) {
  return address == "0.0.0.0" || address == "::";
}
inline bool is_ipv6_text(std::string_view address) {
  return address.find(':') != std::string_view::npos;
}

bool system_knows_ipv6();

/// One for each address, all of one port; without addresses one for all of IPv4 and one for all of
/// IPv6, where the host has that.
Result<std::vector<UdpSocket>> open_udp_sockets(const std::vector<std::string>& addresses,
                                                std::uint16_t port);

/// "192.168.7.1:123", "[::1]:123".
std::string endpoint_text(const std::string& address, std::uint16_t port);

}  // namespace kinalign
