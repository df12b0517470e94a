// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live_socket.h"

#include "kinalign/capture/socket_address.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace kinalign {

Result<LiveSocket> LiveSocket::connected_to(const std::string& host, std::uint16_t port) {
  const FoundAddress address = find_address(host, port, SOCK_DGRAM);
  if (!address) return Failure(Error{"--to", 0, "an address, as 127.0.0.1", shown(host)});
  LiveSocket made(::socket(address->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (made.fd_ < 0 || ::connect(made.fd_, address->ai_addr, address->ai_addrlen) != 0) {
    return Failure(Error{"--to", 0, "a way to " + host + " port " + std::to_string(port),
                         std::strerror(errno)});
  }
  return made;
}

LiveSocket::LiveSocket(LiveSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
LiveSocket& LiveSocket::operator=(LiveSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}
LiveSocket::~LiveSocket() {
  if (fd_ >= 0) ::close(fd_);
}

bool LiveSocket::send(std::span<const std::uint8_t> datagram) const {
  return ::send(fd_, datagram.data(), datagram.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(datagram.size());
}

std::size_t LiveSocket::receive(std::span<std::uint8_t> room) const {
  const ssize_t size = ::recv(fd_, room.data(), room.size(), 0);
  return size > 0 ? static_cast<std::size_t>(size) : 0;
}

}  // namespace kinalign
