// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/udp_socket.h"

#include "kinalign/capture/net/socket_address.h"

#include <linux/sock_diag.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace kinalign {

namespace {

constexpr int receive_buffer = 4 << 20;  // bytes; about a tenth of a second of a flood

bool set(int fd, int level, int name, int value) {
  return ::setsockopt(fd, level, name, &value, sizeof value) == 0;
}

// IPV6_V6ONLY keeps IPv4 off the IPv6 socket, since IPv4 has a socket of its own on the same port.
bool set_options(int fd, int family) {
  if (!set(fd, SOL_SOCKET, SO_RCVBUFFORCE, receive_buffer)) {  // needs CAP_NET_ADMIN
    set(fd, SOL_SOCKET, SO_RCVBUF, receive_buffer);            // limited by net.core.rmem_max
  }
  if (!set(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1)) return false;
  if (family == AF_INET) return set(fd, IPPROTO_IP, IP_PKTINFO, 1);
  return set(fd, IPPROTO_IPV6, IPV6_V6ONLY, 1) && set(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1);
}

/// An address and port in the system's form.
struct Socket {
  Socket(const HostAddress& address, std::uint16_t port) {
    if (is_ipv4(address)) {
      sockaddr_in four{};
      four.sin_family = AF_INET;
      four.sin_port = htons(port);
      std::memcpy(&four.sin_addr, address.data() + 12, 4);
      std::memcpy(&bytes, &four, size = sizeof four);
    } else {
      sockaddr_in6 six{};
      six.sin6_family = AF_INET6;
      six.sin6_port = htons(port);
      std::memcpy(&six.sin6_addr, address.data(), address.size());
      std::memcpy(&bytes, &six, size = sizeof six);
    }
    family = bytes.ss_family;
  }
  const sockaddr* data() const { return reinterpret_cast<const sockaddr*>(&bytes); }

  sockaddr_storage bytes{};
  socklen_t size = 0;
  int family = 0;
};

}  // namespace

Error no_port(std::string at, std::string expected, int code, std::uint16_t port) {
  Error error{std::move(at), 0, std::move(expected), std::strerror(code)};
  if (code == EADDRINUSE) {
    error.found = "a port that another program uses";
    error.kind = ErrorKind::port_taken;
  } else if (code == EACCES || code == EPERM) {
    error.found = port < 1024 ? "no permission for a port below 1024" : "no permission";
    error.kind = ErrorKind::port_forbidden;
  } else if (code == EADDRNOTAVAIL) {
    error.found = "no network interface with this address";
    error.kind = ErrorKind::address_elsewhere;
  }
  return error;
}

std::optional<std::string> spelt_address(const std::string& text) {
  const FoundAddress found = find_address(text, 0, SOCK_DGRAM);
  if (found == nullptr) return std::nullopt;
  return address_text(*found->ai_addr);
}

std::string address_text(const sockaddr& address) {
  std::array<char, NI_MAXHOST> text{};
  const bool four = address.sa_family == AF_INET;
  const socklen_t size = four ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
  ::getnameinfo(&address, size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST);
  return text.data();
}

Result<UdpSocket> UdpSocket::open(const std::string& address, std::uint16_t port) {
  const FoundAddress found = find_address(address, port, SOCK_DGRAM);
  if (found == nullptr) {
    return Failure(Error{"", 0, "an IPv4 or IPv6 address", shown(address)});
  }
  const int type = SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC;
  UdpSocket socket(::socket(found->ai_family, type, 0), address);
  const bool bound = socket.fd_ >= 0 && set_options(socket.fd_, found->ai_family) &&
                     ::bind(socket.fd_, found->ai_addr, found->ai_addrlen) == 0;
  if (!bound) {
    return Failure(no_port(endpoint_text(address, port), "a UDP port to serve on", errno, port));
  }
  socket.port_ = bound_port(socket.fd_);
  return socket;
}

bool UdpSocket::share_port() const { return set(fd_, SOL_SOCKET, SO_REUSEPORT, 1); }

Result<UdpSocket> UdpSocket::connected(const HostAddress& own, std::uint16_t port,
                                       const HostAddress& peer, std::uint16_t peer_port) {
  const Socket here(own, port), there(peer, peer_port);
  const int type = SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC;
  UdpSocket socket(::socket(here.family, type, 0), to_string(own));
  const bool joined = socket.fd_ >= 0 && set_options(socket.fd_, here.family) &&
                      socket.share_port() && ::bind(socket.fd_, here.data(), here.size) == 0 &&
                      ::connect(socket.fd_, there.data(), there.size) == 0;
  if (joined) {
    socket.port_ = port;
    return socket;
  }
  return Failure(
      no_port(endpoint_text(to_string(peer), peer_port), "a UDP socket of its own", errno, port));
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), port_(other.port_), address_(std::move(other.address_)) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(port_, other.port_);
  std::swap(address_, other.address_);
  return *this;
}

UdpSocket::~UdpSocket() {
  if (fd_ >= 0) ::close(fd_);
}

// Any other error, such as too many open files, says nothing about IPv6.
bool system_knows_ipv6() {
  const int fd = ::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd >= 0) ::close(fd);
  return fd >= 0 || errno != EAFNOSUPPORT;
}

Result<std::vector<UdpSocket>> open_udp_sockets(const std::vector<std::string>& addresses,
                                                std::uint16_t port) {
  std::vector<std::string> all = addresses;
  if (all.empty()) all = {"0.0.0.0"};
  if (addresses.empty() && system_knows_ipv6()) all.emplace_back("::");
  std::vector<UdpSocket> sockets;
  for (const std::string& address : all) {
    sockets.push_back(KA_TRY(UdpSocket::open(address, port)));
    // With port 0 the first socket gets a free port, and the others use the same one.
    port = sockets.front().port();
  }
  return sockets;
}

// The kernel counts since the socket was opened.
std::uint64_t dropped_by_kernel(const UdpSocket& socket) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> found{};
  socklen_t size = sizeof found;
  if (::getsockopt(socket.fd(), SOL_SOCKET, SO_MEMINFO, found.data(), &size) != 0) return 0;
  return found[SK_MEMINFO_DROPS];
}

std::string endpoint_text(const std::string& address, std::uint16_t port) {
  return (is_ipv6_text(address) ? "[" + address + "]" : address) + ":" + std::to_string(port);
}

}  // namespace kinalign
