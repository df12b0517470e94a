// SPDX-License-Identifier: Apache-2.0
// When a node joins its network again, and when it had better start anew. What it knows is time,
// whether the radio has a link, and whether the host answers; what it wants, the board does.
#pragma once

#include <cstdint>

namespace kinalign {

enum class LinkAction : std::uint8_t {
  none,
  join,     // leave what is left of the link, and ask for it again
  restart,  // the whole board
};

/// A lost link is asked for at once, then after 1, 2, 4, 8, 16, 16 ... s, so that an access point
/// that starts is not stormed. A link over which nobody answers may be dead though the radio says
/// otherwise: it is joined anew after 30 s, then 60 s ... to 8 min. Without a link for 10 min the
/// radio itself is in doubt.
class LinkPolicy {
 public:
  /// Any time, some times a second. `heard`: a reply was accepted since the last call.
  LinkAction step(std::uint64_t now_us, bool up, bool heard);

 private:
  LinkAction while_down(std::uint64_t now_us);
  LinkAction while_silent(std::uint64_t now_us);

  bool began_ = false, was_up_ = false;
  std::uint64_t lost_us_ = 0;  // since when there is no link
  std::uint64_t next_us_ = 0;  // when to act, should nothing change
  std::uint64_t wait_us_ = 0;  // between tries to join
  std::uint64_t silence_us_ = 0;
};

/// Whether the watchdog may be fed: while the task that samples makes its ticks. Called from the
/// task that sends, it stands for both.
class Watchdog {
 public:
  /// `ticks`: of the sample timer so far.
  bool may_feed(std::uint64_t now_us, std::uint64_t ticks);

 private:
  bool began_ = false;
  std::uint64_t ticks_ = 0, moved_us_ = 0;
};

}  // namespace kinalign
