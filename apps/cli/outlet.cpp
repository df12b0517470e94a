// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/outlet.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <string>
#include <utility>

namespace kinalign {

namespace {

/// Text is written once this number of bytes is held.
constexpr std::size_t enough = std::size_t{64} << 10;
/// Text beyond this number of bytes is dropped if the reader is not waited for.
constexpr std::size_t most_waiting = std::size_t{1} << 20;

}  // namespace

Outlet::~Outlet() {
  if (terminal_ >= 0) ::close(terminal_);
}

/// Opens the terminal anew with O_NONBLOCK. poll(2) reports room on a terminal even if a longer
/// write would sleep, and O_NONBLOCK on the given descriptor would affect other programs that share
/// it.
void Outlet::never_wait() {
  waits_ = false;
  if (terminal_ >= 0 || ::isatty(fd_) == 0) return;
  const std::string path = "/proc/self/fd/" + std::to_string(fd_);
  terminal_ = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

void Outlet::put(std::string_view text) {
  // Dropped whole, so that a reader never sees a part of a line.
  if (!waits_ && held_.size() + text.size() > most_waiting) {
    ++dropped_;
    return;
  }
  held_ += text;
  if (held_.size() >= enough) flush();
}

bool Outlet::takes_more(std::chrono::milliseconds patience) const {
  pollfd waiting{writes_to(), POLLOUT, 0};
  return ::poll(&waiting, 1, static_cast<int>(patience.count())) == 1;  // write() reports faults
}

/// True if the disk was full but may have room again, and the output is not waited for.
bool Outlet::is_full() const { return !waits_ && (fault_ == ENOSPC || fault_ == EDQUOT); }

void Outlet::flush(std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + patience;
  std::string_view left = held_;
  while (!left.empty() && !gave_up()) {
    const auto still = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    // EAGAIN below is the second guard: another program may have filled the pipe in between.
    if (!waits_ && !takes_more(std::max(still, std::chrono::milliseconds{0}))) break;
    // POSIX: a pipe that is writable takes up to PIPE_BUF bytes without blocking.
    const std::size_t piece = waits_ ? left.size() : std::min<std::size_t>(left.size(), PIPE_BUF);
    const ssize_t put = ::write(writes_to(), left.data(), piece);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0 && errno == EAGAIN && !waits_) break;
    fault_ = put < 0 ? errno : 0;
    if (put < 0) break;
    left.remove_prefix(static_cast<std::size_t>(put));
  }
  // On a full disk the text stays: there may be room again later.
  held_.erase(0, gave_up() ? held_.size() : held_.size() - left.size());
}

std::uint64_t Outlet::take_dropped() {
  // With less room, the report of dropped lines could itself be dropped.
  return held_.size() < most_waiting / 2 ? std::exchange(dropped_, 0) : 0;
}

}  // namespace kinalign
