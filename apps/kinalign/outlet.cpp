// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/outlet.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t enough = std::size_t{64} << 10;
constexpr std::size_t most_waiting = std::size_t{1} << 20;

}  // namespace

void Outlet::put(std::string_view text) {
  if (!waits_ && held_.size() + text.size() > most_waiting) {
    ++dropped_;
    return;
  }
  held_ += text;
  if (held_.size() >= enough) flush();
}

bool Outlet::takes_more(std::chrono::milliseconds patience) const {
  pollfd waiting{fd_, POLLOUT, 0};
  return ::poll(&waiting, 1, static_cast<int>(patience.count())) == 1;  // write tells of faults
}

void Outlet::flush(std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + patience;
  std::string_view left = held_;
  while (!left.empty() && fault_ == 0) {
    const auto still = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (!waits_ && !takes_more(std::max(still, std::chrono::milliseconds{0}))) break;
    // A pipe that takes anything takes so much without waiting.
    const std::size_t piece = waits_ ? left.size() : std::min<std::size_t>(left.size(), PIPE_BUF);
    const ssize_t put = ::write(fd_, left.data(), piece);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) {
      fault_ = errno;
    } else {
      left.remove_prefix(static_cast<std::size_t>(put));
    }
  }
  held_.erase(0, fault_ == 0 ? held_.size() - left.size() : held_.size());
}

std::uint64_t Outlet::take_dropped() {
  return held_.size() < most_waiting / 2 ? std::exchange(dropped_, 0) : 0;
}

}  // namespace kinalign
