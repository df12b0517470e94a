// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/sequence_count.h"

#include <algorithm>

namespace kinalign {

namespace {

// Chosen: an hour at 100 Hz. A number further ahead means that the sender restarted.
constexpr std::uint64_t longest_loss = 360'000;
// Chosen: no network was seen that repeats or delays more than 16 packets in a row.
constexpr std::uint64_t restart_run = 16;
// Chosen: the first packet to arrive was delayed behind fewer than this many.
constexpr std::uint64_t near_first = 8;

}  // namespace

SequenceCount::SequenceCount(unsigned bits)
    : mask_(bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1) {}

// Numbers near the newest one are judged against the window of seen numbers; all others go to
// `leap`. The first block undoes a leap: the packet after it continues the old count, so the leap
// was a single stray number, not a restart.
Order SequenceCount::push(std::uint64_t number, bool may_restart) {
  number &= mask_;
  if (leapt_ && near(before_, number) && !near(now_, number)) {
    now_ = before_;
    ++now_.counts.received;
    ++now_.counts.strays;
  }
  leapt_ = false;
  ++now_.counts.received;
  if (now_.counts.received == 1) {
    begin(number);
    return Order::newest;
  }
  if (!near(now_, number)) return leap(number, may_restart);
  const std::uint64_t forward = ahead(now_.newest, number);
  if (forward == 0 || forward >= window) return look_back(number, may_restart);
  now_.counts.lost += forward - 1;
  advance(number);
  return Order::newest;
}

bool SequenceCount::near(const State& state, std::uint64_t number) const {
  return ahead(state.newest, number) < window || ahead(number, state.newest) < window;
}

bool SequenceCount::here(std::uint64_t number) const {
  return (now_.seen[number % window / 64] >> (number % 64) & 1) != 0;
}

// The window is a ring of bits, so the bit of a number also stands for all numbers 1024 apart.
// `advance` therefore clears the bits of the numbers that it passes.
void SequenceCount::mark(std::uint64_t number, bool here) {
  std::uint64_t& word = now_.seen[number % window / 64];
  const std::uint64_t bit = std::uint64_t{1} << (number % 64);
  word = here ? word | bit : word & ~bit;
}

void SequenceCount::begin(std::uint64_t number) {
  now_.seen.fill(0);
  now_.known = 1;
  now_.newest = now_.previous = number;
  now_.old_run = 0;
  mark(number, true);
}

void SequenceCount::advance(std::uint64_t number) {
  const std::uint64_t forward = ahead(now_.newest, number);
  now_.known = std::min(window, now_.known + forward);
  for (std::uint64_t k = 1; k <= std::min(forward, window); ++k) mark(now_.newest + k, false);
  mark(number, true);
  now_.newest = number;
  now_.previous = number;
  now_.old_run = 0;
}

// Judges a number 1024 or more away. The old state is kept in `before_` until the next packet,
// which decides whether the leap is real. It does not count this packet: `push` adds it again if
// the leap is undone.
Order SequenceCount::leap(std::uint64_t number, bool may_restart) {
  const std::uint64_t forward = ahead(now_.newest, number);
  if (!may_restart && forward > mask_ / 2) return old_number(number, may_restart);
  if (!may_restart) {
    ++now_.counts.strays;
    return Order::stray;
  }
  before_ = now_;
  --before_.counts.received;
  leapt_ = true;
  if (forward <= longest_loss && forward <= mask_ / 2) {
    now_.counts.lost += forward - 1;
    advance(number);
    return Order::newest;
  }
  begin(number);
  ++now_.counts.restarts;
  return Order::restart;
}

Order SequenceCount::look_back(std::uint64_t number, bool may_restart) {
  const std::uint64_t back = ahead(number, now_.newest);
  if (here(number) || back >= now_.known + near_first) return old_number(number, may_restart);
  // The packet is older than the first one that arrived, but close to it. The count then begins at
  // this packet, and the numbers between the two are missing.
  if (back >= now_.known) {
    now_.counts.lost += back - now_.known + 1;  // numbers from this one on now count as missing
    now_.known = back + 1;
  }
  mark(number, true);
  --now_.counts.lost;
  ++now_.counts.late;
  now_.previous = number;
  now_.old_run = 0;
  return Order::late;
}

// Handles a number that was not missing: it arrived before, or lies well below the first one.
Order SequenceCount::old_number(std::uint64_t number, bool may_restart) {
  // A sender that restarts close behind its old number looks like a run of duplicates that rise by
  // one. After `restart_run` of them the count begins again.
  const bool rises = may_restart && number == ((now_.previous + 1) & mask_);
  now_.old_run = rises ? now_.old_run + 1 : 1;
  now_.previous = number;
  if (now_.old_run == restart_run) {
    now_.counts.duplicates -= restart_run - 1;
    ++now_.counts.restarts;
    begin(number);
    return Order::restart;
  }
  ++now_.counts.duplicates;
  return Order::duplicate;
}

}  // namespace kinalign
