// SPDX-License-Identifier: Apache-2.0
// Socket addresses of the system, for UDP and TCP.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/core/handle.h"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <bit>
#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

using FoundAddress = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

/// Converts a numeric address. `type` is SOCK_DGRAM or SOCK_STREAM. Returns nullptr if the text is
/// not a numeric address.
FoundAddress find_address(const std::string& address, std::uint16_t port, int type);

/// An address and port in the system's form.
struct SystemAddress {
  sockaddr_storage bytes{};
  socklen_t size = sizeof(sockaddr_storage);

  sockaddr* data() { return reinterpret_cast<sockaddr*>(&bytes); }
};
/// `scope`: the interface number of a link-local address, else 0.
SystemAddress system_address(const HostAddress& host, std::uint16_t port, std::uint32_t scope = 0);

/// The system's addresses and HostAddress contain the same bytes in the same order.
inline HostAddress host_of(const in6_addr& address) { return std::bit_cast<HostAddress>(address); }
inline HostAddress host_of(const in_addr& address) {
  return mapped_ipv4(std::bit_cast<std::array<std::uint8_t, 4>>(address));
}
/// The address and port of one end of a connection, or of a datagram's sender.
NodeAddress address_of(const sockaddr_storage& address);

/// Returns the port to which a socket is bound.
std::uint16_t bound_port(int fd);

/// Opens a non-blocking socket that accepts TCP connections. The kernel stamps the received data.
/// Port 0: any free port.
Result<Handle> listen_tcp(const std::string& address, std::uint16_t port, std::size_t waiting);

/// Makes the kernel stamp received data. If `fd` is a listener, the option applies to all its
/// connections, from their first byte.
void ask_for_stamps(int fd);

}  // namespace kinalign
