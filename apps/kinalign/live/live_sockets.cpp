// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_sockets.h"

#include "kinalign/capture/net/socket_address.h"
#include "kinalign/capture/net/udp_socket.h"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace kinalign {

namespace {

// A connect to a machine that is switched off would otherwise wait for minutes.
constexpr int connect_patience_ms = 5000;

std::string text_of_code(int code) {
  if (code == ECONNREFUSED) return "no program that serves this port";
  return std::strerror(code);
}

/// Waits until a connection is made or has failed; returns its errno, 0 for success.
int result_of(int fd) {
  pollfd waiting{fd, POLLOUT, 0};
  if (::poll(&waiting, 1, connect_patience_ms) != 1) return ETIMEDOUT;
  // The result of a connect that did not block is in SO_ERROR.
  int fault = 0;
  socklen_t size = sizeof fault;
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &fault, &size);
  return fault;
}

/// A connected socket. Errors name `flag`.
Result<Handle> connected(const Endpoint& at, int type, const char* flag, const char* expected) {
  const std::string where = endpoint_text(at.host, at.port);
  const auto fail = [&](std::string found) {
    return Failure(Error{flag, 0, expected + (" at " + where), std::move(found)});
  };
  const FoundAddress found = find_address(at.host, at.port, type);
  // Names are not looked up: find_address() takes numbers only.
  if (found == nullptr) return fail("a name (give the address in numbers)");
  Handle socket(::socket(found->ai_family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.fd() < 0) return fail(text_of_code(errno));
  if (::connect(socket.fd(), found->ai_addr, found->ai_addrlen) == 0) return socket;
  // EINPROGRESS is the normal case for a socket that does not block.
  const int code = errno == EINPROGRESS ? result_of(socket.fd()) : errno;
  if (code != 0) return fail(text_of_code(code));
  return socket;
}

}  // namespace

Result<LiveConnection> LiveConnection::open(const Endpoint& at) {
  return LiveConnection(
      KA_TRY(connected(at, SOCK_STREAM, "--live", "kinalign record with --live-port")));
}

LiveConnection::Came LiveConnection::wait(Duration patience) {
  size_ = 0;
  pollfd waiting{socket_.fd(), POLLIN, 0};
  // Rounding up keeps a short patience from becoming 0, which would make the loop spin.
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  if (::poll(&waiting, 1, static_cast<int>(ms)) <= 0) return Came::nothing;
  const ssize_t got = ::recv(socket_.fd(), buffer_.data(), buffer_.size(), 0);
  // The socket was ready but has no data, or a signal came. Both are no end.
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return Came::nothing;
  if (got <= 0) return Came::end;
  size_ = static_cast<std::size_t>(got);
  return Came::bytes;
}

Result<LiveDatagrams> LiveDatagrams::open(const Endpoint& to) {
  return LiveDatagrams(KA_TRY(connected(to, SOCK_DGRAM, "--send", "a network route")));
}

void LiveDatagrams::send(std::string_view text) const {
  // A datagram that can't be sent is dropped: the next frame follows at once.
  (void)::send(socket_.fd(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace kinalign
