// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/socket_address.h"

#include "kinalign/capture/net/udp_socket.h"

#include <cerrno>
#include <cstring>

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

SystemAddress system_address(const HostAddress& host, std::uint16_t port, std::uint32_t scope) {
  SystemAddress address;
  if (is_ipv4(host)) {
    sockaddr_in four{};
    four.sin_family = AF_INET;
    four.sin_port = htons(port);
    std::memcpy(&four.sin_addr, host.data() + 12, 4);
    std::memcpy(&address.bytes, &four, address.size = sizeof four);
  } else {
    sockaddr_in6 six{};
    six.sin6_family = AF_INET6;
    six.sin6_port = htons(port);
    six.sin6_addr = std::bit_cast<in6_addr>(host);
    six.sin6_scope_id = scope;
    std::memcpy(&address.bytes, &six, address.size = sizeof six);
  }
  return address;
}

NodeAddress address_of(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    sockaddr_in four{};
    std::memcpy(&four, &address, sizeof four);
    return {host_of(four.sin_addr), ntohs(four.sin_port)};
  }
  sockaddr_in6 six{};
  std::memcpy(&six, &address, sizeof six);
  return {host_of(six.sin6_addr), ntohs(six.sin6_port)};
}

std::uint16_t bound_port(int fd) {
  SystemAddress bound;
  ::getsockname(fd, bound.data(), &bound.size);
  return address_of(bound.bytes).port;
}

void ask_for_stamps(int fd) {
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &yes, sizeof yes);
}

// SO_REUSEADDR lets a restarted program listen at once, although old connections of the port have
// not timed out yet.
Result<Handle> listen_tcp(const std::string& address, std::uint16_t port, std::size_t waiting) {
  const FoundAddress found = find_address(address, port, SOCK_STREAM);
  if (found == nullptr) return Failure(no_address(address));
  Handle listener(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(listener.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  ask_for_stamps(listener.fd());
  if (listener.fd() < 0 || ::bind(listener.fd(), found->ai_addr, found->ai_addrlen) != 0 ||
      ::listen(listener.fd(), static_cast<int>(waiting)) != 0) {
    return Failure(no_port(endpoint_text(address, port), "a TCP port to serve on", errno, port));
  }
  return listener;
}

}  // namespace kinalign
