// SPDX-License-Identifier: Apache-2.0
// A bound, non-blocking UDP socket of a server. The kernel gives each datagram a stamp of its
// arrival (CLOCK_REALTIME) and its destination address.
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

/// Returns the error for a port that could not be opened: a text and the ErrorKind. `at`: the
/// address and port. `code`: errno.
Error no_port(std::string at, std::string expected, int code, std::uint16_t port);
/// Returns the error for a text that is not a numeric address.
Error no_address(const std::string& text);

class UdpSocket {
 public:
  /// `address`: IPv4 or IPv6, with %interface if it is link-local. "0.0.0.0" and "::" listen on all
  /// addresses of their family. Port 0: any free port.
  static Result<UdpSocket> open(const std::string& address, std::uint16_t port);
  /// Opens a socket that receives only the datagrams from `peer` to `own`. If another socket is
  /// bound to the port, share_port must have been called for that socket.
  static Result<UdpSocket> connected(const HostAddress& own, std::uint16_t port,
                                     const HostAddress& peer, std::uint16_t peer_port);
  /// Lets other sockets of the same user bind this port, if they allow sharing too. `open` does not
  /// allow sharing, so a second server on the port is refused. Call share_port only after this
  /// socket is bound: binding then fails if another server uses the port.
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

/// Returns the system's spelling of an address that `open` accepts: "0.0.0.0" for "0". Absent if
/// the text is not an address. Host names are not accepted, since a name may have several
/// addresses.
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

/// Opens one socket for each address, all on the same port. Without addresses it opens one socket
/// for all IPv4 addresses and, if the host has IPv6, one for all IPv6 addresses.
Result<std::vector<UdpSocket>> open_udp_sockets(const std::vector<std::string>& addresses,
                                                std::uint16_t port);

/// Text such as "192.168.7.1:123" or "[::1]:123".
std::string endpoint_text(const std::string& address, std::uint16_t port);

}  // namespace kinalign
