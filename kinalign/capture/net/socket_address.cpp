// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/socket_address.h"

#include <netinet/in.h>
#include <sys/socket.h>

namespace kinalign {

// AI_NUMERICHOST prevents a name lookup, which could block.
FoundAddress find_address(const std::string& address, std::uint16_t port, int type) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_PASSIVE;
  hints.ai_socktype = type;
  addrinfo* found = nullptr;
  const int fault = ::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found);
  return {fault == 0 ? found : nullptr, &::freeaddrinfo};
}

std::uint16_t bound_port(int fd) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&bound), &size);
  if (bound.ss_family == AF_INET) return ntohs(reinterpret_cast<sockaddr_in&>(bound).sin_port);
  return ntohs(reinterpret_cast<sockaddr_in6&>(bound).sin6_port);
}

}  // namespace kinalign
