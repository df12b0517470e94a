// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/chrony_query.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>

namespace kinalign {

ChronyQuery::ChronyQuery(std::uint16_t port)
    : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  sockaddr_in chronyd{};
  chronyd.sin_family = AF_INET;
  chronyd.sin_port = htons(port);
  chronyd.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  // A connected socket receives only chronyd's datagrams.
  (void)::connect(fd_, reinterpret_cast<const sockaddr*>(&chronyd), sizeof chronyd);
}

ChronyQuery::ChronyQuery(ChronyQuery&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      sequence_(other.sequence_),
      asked_at_(other.asked_at_),
      answered_at_(other.answered_at_),
      answer_(other.answer_) {}

ChronyQuery& ChronyQuery::operator=(ChronyQuery&& other) noexcept {
  std::swap(fd_, other.fd_);
  sequence_ = other.sequence_;
  asked_at_ = other.asked_at_;
  answered_at_ = other.answered_at_;
  answer_ = other.answer_;
  return *this;
}

ChronyQuery::~ChronyQuery() {
  if (fd_ >= 0) ::close(fd_);
}

// Answers are collected on the next call, so this call never waits.
std::optional<ChronyTracking> ChronyQuery::latest(HostTime now) {
  constexpr Duration again = std::chrono::seconds(2), good_for = std::chrono::seconds(10);
  receive(now);
  if (!asked_at_ || now - *asked_at_ >= again) {
    asked_at_ = now;
    // Each request has its own number. A late answer to an earlier request is not accepted.
    const auto request = chrony_tracking_request(++sequence_);
    // an error means that no chronyd is running
    (void)::send(fd_, request.data(), request.size(), MSG_NOSIGNAL);
  }
  if (!answered_at_ || now - *answered_at_ > good_for) return std::nullopt;
  return answer_;
}

// Used once, when the server starts; later answers are collected without waiting.
void ChronyQuery::wait() const {
  constexpr int most_ms = 100;
  pollfd waiting{fd_, POLLIN, 0};
  (void)::poll(&waiting, 1, most_ms);
}

// Only the answer to the newest request counts; the others are discarded.
void ChronyQuery::receive(HostTime now) {
  constexpr int most = 4;  // limit on answers read in one call
  std::array<std::uint8_t, 256> bytes{};
  for (int i = 0; i < most; ++i) {
    const ssize_t got = ::recv(fd_, bytes.data(), bytes.size(), 0);
    if (got < 0) return;
    const auto answer =
        decode_chrony_tracking(std::span(bytes).first(static_cast<std::size_t>(got)), sequence_);
    if (!answer) continue;
    answer_ = *answer;
    answered_at_ = now;
  }
}

}  // namespace kinalign
