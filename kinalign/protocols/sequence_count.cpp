// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/sequence_count.h"

namespace kinalign {

namespace {

// A chosen limit: an hour at 100 Hz. If a number is further ahead, the sender has restarted.
constexpr std::int64_t longest_loss = 360'000;
// A chosen limit: no observed network duplicates or delays more than 16 packets in a row.
constexpr std::uint64_t restart_run = 16;
// A chosen limit: at most this many older packets arrive after the first packet.
constexpr std::int64_t near_first = 8;

}  // namespace

SequenceCounts SequenceCount::counts() const {
  SequenceCounts counts = now_.counts;
  counts.lost += now_.numbers.missing();
  return counts;
}

// The first block undoes a leap (a number 1024 or more away). If the packet after a leap continues
// the old count, the leap was a single outlier number and not a restart.
Order SequenceCount::push(std::uint64_t sent, bool may_restart) {
  if (leapt_ && is_near(before_, sent) && !is_near(now_, sent)) {
    now_ = before_;
    ++runs_;
    ++now_.counts.received;
    ++now_.counts.outliers;
  }
  leapt_ = false;
  ++now_.counts.received;
  const std::int64_t number = now_.numbers.unwrap(sent, bits_);
  if (!is_near(now_, sent)) return leap(number, may_restart);
  const Counter::Place place = now_.numbers.place_of(number);
  // A number below the first one is accepted only if it is close to the first one. The count then
  // begins at this number, and the numbers in between are missing.
  const bool is_new = place == Counter::Place::ahead ||
                      (place == Counter::Place::late &&
                       Counter::difference(now_.numbers.first(), number) <= near_first);
  if (!is_new) return old_number(number, may_restart);
  take(number);
  if (place == Counter::Place::ahead) return Order::newest;
  ++now_.counts.late;
  return Order::late;
}

bool SequenceCount::is_near(const State& state, std::uint64_t sent) const {
  if (state.numbers.empty()) return true;
  const std::int64_t steps = state.numbers.steps_to(state.numbers.unwrap(sent, bits_));
  return steps < Counter::window && steps > -Counter::window;
}

void SequenceCount::take(std::int64_t number) {
  now_.numbers.take(number);
  now_.previous = number;
  now_.old_run = 0;
}

// Begins a new count after a restart of the sender.
void SequenceCount::begin(std::int64_t number) {
  now_.counts.lost += now_.numbers.missing();
  now_.numbers = {};
  ++now_.counts.restarts;
  ++runs_;
  take(now_.numbers.unwrap(static_cast<std::uint64_t>(number), bits_));
}

// Handles a number 1024 or more away. `before_` keeps the old state until the next packet, which
// shows whether the leap is real. The old state does not count this packet. If the leap is undone,
// `push` adds it again.
Order SequenceCount::leap(std::int64_t number, bool may_restart) {
  const std::int64_t steps = now_.numbers.steps_to(number);
  if (!may_restart && steps < 0) return old_number(number, may_restart);
  if (!may_restart) {
    ++now_.counts.outliers;
    return Order::outlier;
  }
  before_ = now_;
  --before_.counts.received;
  leapt_ = true;
  if (steps > 0 && steps <= longest_loss) {
    take(number);
    return Order::newest;
  }
  begin(number);
  return Order::restart;
}

// Handles a number that was not missing: it arrived before, or is far below the first number.
Order SequenceCount::old_number(std::int64_t number, bool may_restart) {
  // If a sender restarts less than 1024 numbers back, its packets look like a run of duplicates
  // that rise by one. After `restart_run` such packets the count begins again.
  const bool rises = may_restart && Counter::difference(number, now_.previous) == 1;
  now_.old_run = rises ? now_.old_run + 1 : 1;
  now_.previous = number;
  if (now_.old_run == restart_run) {
    now_.counts.duplicates -= restart_run - 1;
    begin(number);
    return Order::restart;
  }
  ++now_.counts.duplicates;
  return Order::duplicate;
}

}  // namespace kinalign
