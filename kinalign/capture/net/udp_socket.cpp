// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/udp_socket.h"

#include "kinalign/capture/net/socket_address.h"

#include <linux/sock_diag.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace kinalign {

namespace {

constexpr int receive_buffer = 4 << 20;  // bytes; holds about 0.1 s of a flood of datagrams

bool set(int fd, int level, int name, int value) {
  return ::setsockopt(fd, level, name, &value, sizeof value) == 0;
}

// IPV6_V6ONLY keeps IPv4 datagrams off the IPv6 socket. Another socket on the same port receives
// IPv4.
bool set_options(int fd, int family) {
  if (!set(fd, SOL_SOCKET, SO_RCVBUFFORCE, receive_buffer)) {  // needs CAP_NET_ADMIN
    set(fd, SOL_SOCKET, SO_RCVBUF, receive_buffer);            // limited by net.core.rmem_max
  }
  if (!set(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1)) return false;
  if (family == AF_INET) return set(fd, IPPROTO_IP, IP_PKTINFO, 1);
  return set(fd, IPPROTO_IPV6, IPV6_V6ONLY, 1) && set(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1);
}

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

Error no_address(const std::string& text) {
  return {"", 0, "an IPv4 or IPv6 address", shown(text)};
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

UdpSocket::UdpSocket(int family, std::string address)
    : handle_(::socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)),
      address_(std::move(address)) {
  if (fd() >= 0 && !set_options(fd(), family)) handle_ = Handle();
}

Result<UdpSocket> UdpSocket::open(const std::string& address, std::uint16_t port) {
  const FoundAddress found = find_address(address, port, SOCK_DGRAM);
  if (found == nullptr) return Failure(no_address(address));
  UdpSocket socket(found->ai_family, address);
  if (socket.fd() < 0 || ::bind(socket.fd(), found->ai_addr, found->ai_addrlen) != 0) {
    return Failure(no_port(endpoint_text(address, port), "a UDP port to serve on", errno, port));
  }
  socket.port_ = bound_port(socket.fd());
  return socket;
}

bool UdpSocket::share_port() const { return set(fd(), SOL_SOCKET, SO_REUSEPORT, 1); }

Result<UdpSocket> UdpSocket::connected(const HostAddress& own, std::uint16_t port,
                                       const HostAddress& peer, std::uint16_t peer_port) {
  SystemAddress here = system_address(own, port), there = system_address(peer, peer_port);
  UdpSocket socket(here.bytes.ss_family, to_string(own));
  const bool joined = socket.fd() >= 0 && socket.share_port() &&
                      ::bind(socket.fd(), here.data(), here.size) == 0 &&
                      ::connect(socket.fd(), there.data(), there.size) == 0;
  if (joined) {
    socket.port_ = port;
    return socket;
  }
  return Failure(
      no_port(endpoint_text(to_string(peer), peer_port), "a UDP socket of its own", errno, port));
}

// Other errors, such as too many open files, don't show whether the system has IPv6.
bool system_knows_ipv6() {
  return Handle(::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0)).fd() >= 0 ||
         errno != EAFNOSUPPORT;
}

Result<std::vector<UdpSocket>> open_udp_sockets(const std::vector<std::string>& addresses,
                                                std::uint16_t port) {
  std::vector<std::string> all = addresses;
  if (all.empty()) all = {"0.0.0.0"};
  if (addresses.empty() && system_knows_ipv6()) all.emplace_back("::");
  std::vector<UdpSocket> sockets;
  for (const std::string& address : all) {
    sockets.push_back(KA_TRY(UdpSocket::open(address, port)));
    // If the port is 0, the first socket gets a free port, and the other sockets use the same port.
    port = sockets.front().port();
  }
  return sockets;
}

// The kernel counts from the opening of the socket.
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
