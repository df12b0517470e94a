// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/link_policy.h"

namespace kinalign {

namespace {

constexpr std::uint64_t second_us = 1'000'000;
constexpr std::uint64_t longest_wait_us = 16 * second_us;
constexpr std::uint64_t first_silence_us = 30 * second_us, longest_silence_us = 480 * second_us;
constexpr std::uint64_t restart_after_us = 600 * second_us;
constexpr std::uint64_t stuck_after_us = 2 * second_us;

std::uint64_t doubled(std::uint64_t wait_us, std::uint64_t longest_us) {
  return 2 * wait_us < longest_us ? 2 * wait_us : longest_us;
}

}  // namespace

LinkAction LinkPolicy::step(std::uint64_t now_us, bool up, bool answered) {
  const bool changed = !began_ || up != was_up_;
  began_ = true;
  was_up_ = up;
  if (answered || wait_us_ == 0) {
    // The short waits begin again only after a reply, not for a link that comes and goes.
    wait_us_ = second_us;
    silence_us_ = first_silence_us;
  }
  if (changed) {
    lost_us_ = now_us;
    next_us_ = up ? now_us + silence_us_ : now_us;
  } else if (up && answered) {
    next_us_ = now_us + silence_us_;
  }
  return up ? while_silent(now_us) : while_down(now_us);
}

LinkAction LinkPolicy::while_down(std::uint64_t now_us) {
  if (now_us - lost_us_ >= restart_after_us) return LinkAction::restart;
  if (now_us < next_us_) return LinkAction::none;
  next_us_ = now_us + wait_us_;
  wait_us_ = doubled(wait_us_, longest_wait_us);
  return LinkAction::join;
}

LinkAction LinkPolicy::while_silent(std::uint64_t now_us) {
  if (now_us < next_us_) return LinkAction::none;
  silence_us_ = doubled(silence_us_, longest_silence_us);
  next_us_ = now_us + silence_us_;
  return LinkAction::join;
}

bool Watchdog::may_feed(std::uint64_t now_us, std::uint64_t ticks) {
  if (!began_ || ticks != ticks_) {
    began_ = true;
    ticks_ = ticks;
    moved_us_ = now_us;
  }
  return now_us - moved_us_ <= stuck_after_us;
}

}  // namespace kinalign
