// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/live_socket.h"

#include "kinalign/capture/net/socket_address.h"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace kinalign {

LiveTraffic& LiveTraffic::operator+=(const LiveTraffic& more) {
  sent += more.sent;
  refused += more.refused;
  received += more.received;
  return *this;
}

Result<void> check_live_address(const std::string& host) {
  if (find_address(host, 1, SOCK_DGRAM)) return {};
  return Failure(Error{"--to", 0, "an address in numbers, such as 127.0.0.1", shown(host)});
}

Result<LiveSocket> LiveSocket::connected_to(const std::string& host, std::uint16_t port) {
  // The check is repeated here, so that `address` below is never null.
  KA_TRY(check_live_address(host));
  const FoundAddress address = find_address(host, port, SOCK_DGRAM);
  LiveSocket made(::socket(address->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  // A connected UDP socket receives only from its peer, and reports ICMP messages of the peer.
  if (made.fd() < 0 || ::connect(made.fd(), address->ai_addr, address->ai_addrlen) != 0) {
    return Failure(Error{"--to", 0, "a network route to " + host + " port " + std::to_string(port),
                         std::strerror(errno)});
  }
  return made;
}

/// Reads and counts a refusal by the host: an ICMP message that no program listens at the port. The
/// kernel keeps the message in the socket; the next send or receive would return it as an error and
/// do nothing else.
void LiveSocket::read_refusal() {
  // getsockopt(SO_ERROR) also clears the error.
  int refusal = 0;
  socklen_t size = sizeof refusal;
  const bool asked = ::getsockopt(fd(), SOL_SOCKET, SO_ERROR, &refusal, &size) == 0;
  if (asked && refusal != 0) ++traffic_.refused;
}

bool LiveSocket::send(std::span<const std::uint8_t> datagram) {
  read_refusal();
  ++traffic_.sent;
  const bool taken = ::send(fd(), datagram.data(), datagram.size(), MSG_NOSIGNAL) ==
                     static_cast<ssize_t>(datagram.size());
  if (!taken) ++traffic_.refused;
  return taken;
}

std::size_t LiveSocket::receive(std::span<std::uint8_t> room) {
  read_refusal();
  const ssize_t size = ::recv(fd(), room.data(), room.size(), 0);
  // A negative size means that no datagram has arrived.
  if (size < 0) return 0;
  ++traffic_.received;
  return static_cast<std::size_t>(size);
}

const LiveTraffic& LiveSocket::traffic() {
  read_refusal();
  return traffic_;
}

}  // namespace kinalign
