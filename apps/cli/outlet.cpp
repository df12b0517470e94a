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

/// put() writes the held text once it has this number of bytes.
constexpr std::size_t enough = std::size_t{64} << 10;
/// After never_wait(), text beyond this number of held bytes is dropped.
constexpr std::size_t most_waiting = std::size_t{1} << 20;

}  // namespace

Outlet::~Outlet() {
  if (terminal_ >= 0) ::close(terminal_);
}

/// Opens the terminal a second time, with O_NONBLOCK. poll(2) may report room on a terminal
/// although a long write() would block. O_NONBLOCK on the given descriptor would also affect other
/// programs that use the same terminal.
void Outlet::never_wait() {
  waits_ = false;
  if (terminal_ >= 0 || ::isatty(fd_) == 0) return;
  const std::string path = "/proc/self/fd/" + std::to_string(fd_);
  terminal_ = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

void Outlet::put(std::string_view text) {
  // The text is dropped as a whole, so that a reader never sees a part of a line.
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

/// True if the disk was full at the last write and the text is kept for a later try.
bool Outlet::is_full() const { return !waits_ && (fault_ == ENOSPC || fault_ == EDQUOT); }

void Outlet::flush(std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + patience;
  std::string_view left = held_;
  while (!left.empty() && !gave_up()) {
    const auto still = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    // write() may still fail with EAGAIN (handled below), if another program filled the pipe
    // meanwhile.
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
  // If the disk is full, the text is kept, because there may be room later.
  held_.erase(0, gave_up() ? held_.size() : held_.size() - left.size());
}

std::uint64_t Outlet::take_dropped() {
  // With less than half of the room free, the line that reports dropped lines could itself be
  // dropped.
  return held_.size() < most_waiting / 2 ? std::exchange(dropped_, 0) : 0;
}

}  // namespace kinalign
