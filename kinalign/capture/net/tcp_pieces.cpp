// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/kernel_stamp.h"
#include "kinalign/capture/net/pieces.h"
#include "kinalign/capture/net/socket_address.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace kinalign {

namespace {

// Greatest number of bytes in one read. A read has one stamp, the arrival of its last bytes. If the
// machine was stopped, waiting data therefore gets more accurate stamps from smaller reads. Frames
// have 1 to 4 KB. The kernel merges waiting packets and their stamps (over loopback 16 frames of
// 1480 bytes).
constexpr std::size_t read_size = std::size_t{4} << 10;
constexpr int reads_in_turn = 64;  // reads of one connection before other ports are read
constexpr std::size_t most_links = 8;
constexpr Duration between_tries = std::chrono::seconds(1);
// chosen, not measured; every device sends many messages a second
constexpr Duration idle_after = std::chrono::seconds(3);

/// Detects within half a minute that a device has vanished without closing the connection.
void keep_alive(int fd) {
  const auto set = [fd](int level, int name, int value) {
    ::setsockopt(fd, level, name, &value, sizeof value);
  };
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 10);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 5);
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
}

/// Limits an attempt to connect to about three seconds (two requests, timeouts of 1 and 2 s;
/// measured 3.1 s). The system itself repeats the request after up to 64 s. A device that is
/// switched on during such a wait would be connected that late.
void ask_briefly(int fd) {
  const int once_more = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_SYNCNT, &once_more, sizeof once_more);
}

/// Calls recv(2) and also returns the arrival of the last byte. After a lost segment, earlier bytes
/// may have arrived later than the last byte. Clock bounds stay correct, because the earlier bytes
/// were sent before the last byte.
ssize_t receive_stamped(int fd, std::span<char> room, std::optional<Time>& stamp) {
  alignas(cmsghdr) std::array<std::uint8_t, 128> control{};
  iovec in{room.data(), room.size()};
  msghdr head{};
  head.msg_iov = &in;
  head.msg_iovlen = 1;
  head.msg_control = control.data();
  head.msg_controllen = control.size();
  const ssize_t got = ::recvmsg(fd, &head, 0);
  if (got <= 0) return got;
  for (cmsghdr* c = CMSG_FIRSTHDR(&head); c != nullptr; c = CMSG_NXTHDR(&head, c)) {
    if (const auto kernel_time = kernel_stamp(*c)) stamp = kernel_time;
  }
  return got;
}

}  // namespace

TcpPieces::TcpPieces(std::string address, std::uint16_t port, Handle listener)
    : address_(std::move(address)),
      port_(port),
      listener_(std::move(listener)),
      buffer_(read_size) {}

Result<TcpPieces> TcpPieces::connect(const std::string& address, std::uint16_t port) {
  if (address.empty() || find_address(address, port, SOCK_STREAM) == nullptr) {
    return Failure(no_address(address));
  }
  return TcpPieces(address, port, Handle());
}

Result<TcpPieces> TcpPieces::listen(const std::string& address, std::uint16_t port) {
  Handle listener = KA_TRY(listen_tcp(address.empty() ? "0.0.0.0" : address, port, most_links));
  const std::uint16_t bound = bound_port(listener.fd());
  return TcpPieces(address, bound, std::move(listener));
}

void TcpPieces::add_fds(std::vector<int>& fds) const {
  if (listener_.fd() >= 0) fds.push_back(listener_.fd());
  for (const Link& link : links_) fds.push_back(link.socket.fd());
}

void TcpPieces::accept(HostTime now) {
  for (;;) {
    Handle socket(::accept4(listener_.fd(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (socket.fd() < 0) return;
    if (links_.size() == most_links && !give_up_idle(now)) {
      ++counts_.refused;
      continue;  // the destructor of `socket` closes the refused connection
    }
    keep_alive(socket.fd());
    links_.push_back({std::move(socket), now});
  }
}

/// A device that vanished without closing its connection must not prevent the next connection. The
/// connection that was silent longest is closed. Returns false if no connection was silent long
/// enough.
bool TcpPieces::give_up_idle(HostTime now) {
  const auto idlest = std::min_element(
      links_.begin(), links_.end(),
      [](const Link& a, const Link& b) { return a.last_arrival < b.last_arrival; });
  if (now - idlest->last_arrival < idle_after) return false;
  links_.erase(idlest);
  return true;
}

// One attempt per second. The connection may complete in the background.
void TcpPieces::try_to_connect(HostTime now) {
  if (now < next_try_) return;
  next_try_ = now + between_tries;
  const FoundAddress found = find_address(address_, port_, SOCK_STREAM);
  if (found == nullptr) return;
  Handle socket(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.fd() < 0) return;
  keep_alive(socket.fd());
  ask_briefly(socket.fd());
  ask_for_stamps(socket.fd());
  if (::connect(socket.fd(), found->ai_addr, found->ai_addrlen) != 0 && errno != EINPROGRESS) {
    return;
  }
  links_.push_back({std::move(socket), now});
}

// A listening port may have several connections. A port that connects has at most one.
void TcpPieces::drain(HostAxis& axis, const TakePiece& take) {
  if (listener_.fd() >= 0) {
    accept(axis.now());
  } else if (links_.empty()) {
    try_to_connect(axis.now());
  }
  std::erase_if(links_, [&](Link& link) { return !drain_link(link, axis, take); });
}

void TcpPieces::send(std::size_t sender, std::span<const std::uint8_t> bytes) {
  for (const Link& link : links_) {
    if (!link.sender || link.sender->number != sender) continue;
    // The number belongs to another sender by now, so these bytes are not for this connection.
    if (link.sender->serial != senders_.at(sender).serial) continue;
    const ssize_t sent =
        ::send(link.socket.fd(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent == static_cast<ssize_t>(bytes.size())) return;
    ++counts_.unsent;
    // The rest can't be sent later, because the next message would begin inside this message.
    if (sent > 0) ::shutdown(link.socket.fd(), SHUT_RDWR);
    return;
  }
}

/// Checks whether the pending connection was established. Returns false if it failed.
bool TcpPieces::settle(Link& link) {
  int fault = 0;
  socklen_t size = sizeof fault;
  ::getsockopt(link.socket.fd(), SOL_SOCKET, SO_ERROR, &fault, &size);
  if (fault != 0) return false;
  SystemAddress peer;
  link.connected = ::getpeername(link.socket.fd(), peer.data(), &peer.size) == 0;
  if (link.connected) link.address = address_of(peer.bytes);
  if (link.connected) ++counts_.links;
  return true;
}

// Returns false if the connection is closed or broken.
bool TcpPieces::drain_link(Link& link, HostAxis& axis, const TakePiece& take) {
  if (!link.connected && !settle(link)) return false;
  for (int turn = 0; link.connected && turn < reads_in_turn; ++turn) {
    std::optional<Time> stamp;
    const ssize_t got = receive_stamped(link.socket.fd(), buffer_, stamp);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    if (got == 0) return false;
    // The bracket is read for each stamp, because reading up to 64 times may take long.
    axis.look();
    const HostTime arrival = link.last_arrival = axis.arrival(stamp);
    const auto sender = senders_.number(link.sender, link.address.host, link.address.port, arrival);
    ++(sender ? counts_.pieces : counts_.refused);
    if (!sender) continue;
    const auto size = static_cast<std::size_t>(got);
    counts_.bytes += size;
    take({*sender, {buffer_.data(), size}, arrival});
  }
  return true;
}

}  // namespace kinalign
