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

// Without this limit, connecting to a machine that is switched off would take minutes.
constexpr int connect_patience_ms = 5000;

std::string text_of_code(int code) {
  if (code == ECONNREFUSED) return "no program that serves this port";
  return std::strerror(code);
}

/// Waits until a connection is made or has failed. Returns 0 or the errno of the failure.
int result_of(int fd) {
  pollfd waiting{fd, POLLOUT, 0};
  if (::poll(&waiting, 1, connect_patience_ms) != 1) return ETIMEDOUT;
  // SO_ERROR has the result of a connect() that did not block.
  int fault = 0;
  socklen_t size = sizeof fault;
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &fault, &size);
  return fault;
}

/// Makes a connected socket. Errors name `flag`.
Result<Handle> connected(const Endpoint& at, int type, const char* flag, const char* expected) {
  const std::string where = endpoint_text(at.host, at.port);
  const auto fail = [&](std::string found) {
    return Failure(Error{flag, 0, expected + (" at " + where), std::move(found)});
  };
  const FoundAddress found = find_address(at.host, at.port, type);
  // find_address() accepts numeric addresses only and looks up no names.
  if (found == nullptr) return fail("a name (give the address in numbers)");
  Handle socket(::socket(found->ai_family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.fd() < 0) return fail(text_of_code(errno));
  if (::connect(socket.fd(), found->ai_addr, found->ai_addrlen) == 0) return socket;
  // EINPROGRESS is normal for a socket that does not block.
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
  // The time is rounded up: a wait of 0 ms would make the caller's loop run without pause.
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  if (::poll(&waiting, 1, static_cast<int>(ms)) <= 0) return Came::nothing;
  const ssize_t got = ::recv(socket_.fd(), buffer_.data(), buffer_.size(), 0);
  // Either poll() was wrong about data, or a signal came. The connection goes on in both cases.
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return Came::nothing;
  if (got <= 0) return Came::end;
  size_ = static_cast<std::size_t>(got);
  return Came::bytes;
}

Result<LiveDatagrams> LiveDatagrams::open(const Endpoint& to) {
  return LiveDatagrams(KA_TRY(connected(to, SOCK_DGRAM, "--send", "a network route")));
}

void LiveDatagrams::send(std::string_view text) const {
  // A datagram that can't be sent is dropped, because the next frame follows at once.
  (void)::send(socket_.fd(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace kinalign
