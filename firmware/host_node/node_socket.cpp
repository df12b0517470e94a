// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/node_socket.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace kinalign {

namespace {

struct Free {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};

// Repeats a call that failed for an earlier datagram: if the server is not there yet, it answers
// that datagram by ICMP, and the next call returns the error and does nothing else.
template <class Call>
ssize_t past_refusals(Call call) {
  ssize_t done = call();
  for (int i = 0; i < 4 && done < 0 && (errno == ECONNREFUSED || errno == EINTR); ++i)
    done = call();
  return done;
}

}  // namespace

Tried<NodeSocket> NodeSocket::connected_to(const std::string& host, const std::string& port) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), port.c_str(), &wanted, &found);
  const std::unique_ptr<addrinfo, Free> list(found);
  if (error != 0) return failure(host + ": expected an address, found: " + gai_strerror(error));
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    NodeSocket made(::socket(one->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (made.descriptor_ < 0) continue;
    if (::connect(made.descriptor_, one->ai_addr, one->ai_addrlen) == 0) return made;
  }
  return failure(host + ":" + port + ": expected a network route, found: " + std::strerror(errno));
}

NodeSocket::NodeSocket(NodeSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

NodeSocket& NodeSocket::operator=(NodeSocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

NodeSocket::~NodeSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool NodeSocket::send(std::span<const std::uint8_t> datagram) {
  return past_refusals([&] { return ::send(descriptor_, datagram.data(), datagram.size(), 0); }) >=
         0;
}

bool NodeSocket::receive(std::span<std::uint8_t> room, std::size_t& size) {
  const ssize_t got =
      past_refusals([&] { return ::recv(descriptor_, room.data(), room.size(), 0); });
  if (got < 0) return false;
  size = static_cast<std::size_t>(got);
  return true;
}

}  // namespace kinalign
