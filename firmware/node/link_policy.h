// SPDX-License-Identifier: Apache-2.0
// Decides when a node joins its network again, and when it restarts. It knows the time, whether the
// radio has a link, and whether the host answers; the board carries out its decisions.
#pragma once

#include <cstdint>

namespace kinalign {

enum class LinkAction : std::uint8_t {
  none,
  join,     // leave the old link, and ask for a new one
  restart,  // restart the whole board
};

/// A node asks for a lost link at once, then after 1, 2, 4, 8, 16, 16 ... s, so that many nodes do
/// not overload an access point that starts. A link on which no host answers may be dead though the
/// radio reports it: the node joins anew after 30 s, then 60 s ... to 8 min. After 10 min without a
/// link the radio itself may be at fault, and the board restarts.
class LinkPolicy {
 public:
  /// To be called some times a second. `answered`: a reply was accepted since the last call.
  LinkAction step(std::uint64_t now_us, bool up, bool answered);

 private:
  LinkAction while_down(std::uint64_t now_us);
  LinkAction while_silent(std::uint64_t now_us);

  bool began_ = false, was_up_ = false;
  std::uint64_t lost_us_ = 0;  // time at which the link was lost
  std::uint64_t next_us_ = 0;  // time of the next action if nothing changes
  std::uint64_t wait_us_ = 0;  // wait between two tries to join
  std::uint64_t silence_us_ = 0;
};

/// Says whether the watchdog may be fed: as long as the sampling task makes its ticks. The sending
/// task calls it, so the watchdog covers both tasks.
class Watchdog {
 public:
  /// `ticks`: the ticks of the sample timer so far.
  bool may_feed(std::uint64_t now_us, std::uint64_t ticks);

 private:
  bool began_ = false;
  std::uint64_t ticks_ = 0, moved_us_ = 0;
};

}  // namespace kinalign
