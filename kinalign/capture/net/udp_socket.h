// SPDX-License-Identifier: Apache-2.0
// A bound, non-blocking UDP socket of a server. For each datagram the kernel supplies a stamp of
// its arrival (CLOCK_REALTIME) and its destination address.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/core/handle.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct sockaddr;  // <sys/socket.h>

namespace kinalign {

/// The error for a port that could not be opened: a text and an ErrorKind for the cause. `at`: the
/// address and port. `code`: errno.
Error no_port(std::string at, std::string expected, int code, std::uint16_t port);
/// The error for a text that is no numeric address.
Error no_address(const std::string& text);

class UdpSocket {
 public:
  /// `address`: IPv4 or IPv6, with %interface if it is link-local. "0.0.0.0" and "::" listen on all
  /// addresses of their family. Port 0: any free port.
  static Result<UdpSocket> open(const std::string& address, std::uint16_t port);
  /// Opens a socket for the datagrams from `peer` to `own` alone. An open socket of the same port
  /// must have called share_port.
  static Result<UdpSocket> connected(const HostAddress& own, std::uint16_t port,
                                     const HostAddress& peer, std::uint16_t peer_port);
  /// Allows more sockets of the same user on this port. They must share the port too. `open` does
  /// not share it, so a second server is still refused. Call it only after this socket is bound, so
  /// that this socket is refused if a server is running.
  bool share_port() const;

  int fd() const { return handle_.fd(); }
  std::uint16_t port() const { return port_; }
  const std::string& address() const { return address_; }

 private:
  /// A socket with the options of a server; -1 if the system refuses one of them.
  UdpSocket(int family, std::string address);

  Handle handle_;
  std::uint16_t port_ = 0;
  std::string address_;
};

/// Datagrams that the kernel dropped, because of a filter or because the buffer was full.
std::uint64_t dropped_by_kernel(const UdpSocket& socket);

/// The system's spelling of an address that `open` accepts: "0.0.0.0" for "0". Absent if the text
/// is not an address. Names are not accepted, since a name may have several addresses.
std::optional<std::string> spelt_address(const std::string& text);
std::string address_text(const sockaddr& address);

/// Returns whether `address`, in the system's spelling, is the wildcard address of its family.
inline bool is_any_address(std::string_view address) {
  return address == "0.0.0.0" || address == "::";
}
inline bool is_ipv6_text(std::string_view address) {
  return address.find(':') != std::string_view::npos;
}

bool system_knows_ipv6();

/// Opens one socket for each address, all on the same port. Without addresses it opens one for all
/// of IPv4 and, if the host has IPv6, one for all of IPv6.
Result<std::vector<UdpSocket>> open_udp_sockets(const std::vector<std::string>& addresses,
                                                std::uint16_t port);

/// Text such as "192.168.7.1:123" or "[::1]:123".
std::string endpoint_text(const std::string& address, std::uint16_t port);

}  // namespace kinalign
