// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/chrony_query.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace kinalign {

ChronyQuery::ChronyQuery(std::uint16_t port)
    : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  sockaddr_in chronyd{};
  chronyd.sin_family = AF_INET;
  chronyd.sin_port = htons(port);
  chronyd.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  // A connected socket receives datagrams only from chronyd.
  (void)::connect(socket_.fd(), reinterpret_cast<const sockaddr*>(&chronyd), sizeof chronyd);
}

// Answers are collected on the next call, so this call never waits.
std::optional<ChronyTracking> ChronyQuery::latest(HostTime now) {
  constexpr Duration again = std::chrono::seconds(2), good_for = std::chrono::seconds(10);
  receive(now);
  if (!asked_at_ || now - *asked_at_ >= again) {
    asked_at_ = now;
    // Each request has a new number, so that late answers to earlier requests are recognised.
    const auto request = chrony_tracking_request(++sequence_);
    // an error means that no chronyd is running
    (void)::send(socket_.fd(), request.data(), request.size(), MSG_NOSIGNAL);
  }
  if (!answered_at_ || now - *answered_at_ > good_for) return std::nullopt;
  return answer_;
}

// Called once, when the server starts. Later calls collect answers without waiting.
void ChronyQuery::wait() const {
  constexpr int most_ms = 100;
  pollfd waiting{socket_.fd(), POLLIN, 0};
  (void)::poll(&waiting, 1, most_ms);
}

// Only the answer to the newest request is used.
void ChronyQuery::receive(HostTime now) {
  constexpr int most = 4;  // limit on answers read in one call
  std::array<std::uint8_t, 256> bytes{};
  for (int i = 0; i < most; ++i) {
    const ssize_t got = ::recv(socket_.fd(), bytes.data(), bytes.size(), 0);
    if (got < 0) return;
    const auto answer =
        decode_chrony_tracking(std::span(bytes).first(static_cast<std::size_t>(got)), sequence_);
    if (!answer) continue;
    answer_ = *answer;
    answered_at_ = now;
  }
}

}  // namespace kinalign
