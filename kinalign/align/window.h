// SPDX-License-Identifier: Apache-2.0
// The samples of a stream around the rows being made: a stream is pulled block by block, stamps
// that do not rise (motion/stamps.h) are dropped, and what lies behind is forgotten.
#pragma once

#include "kinalign/motion/stamps.h"
#include "kinalign/take/recording.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

// Rows first.. of one block appended to another, and rows dropped from the front or the last one.
// The number of values in a row follows from the arrays' sizes. For all three kinds of blocks.
template <class Frames>
void append_rows(Frames& to, const Frames& from, std::size_t first, std::size_t count);
template <class Frames>
void drop_front(Frames& rows, std::size_t count);
template <class Frames>
void drop_last(Frames& rows);

/// Stretches without samples within a span.
struct GapCount {
  std::int64_t limit_ns = 0;              // longer ones count
  std::int64_t begin_ns = 0, end_ns = 0;  // of the take
  std::uint64_t gaps = 0;
  std::int64_t time_ns = 0;  // sum of their lengths within the span

  void add(std::int64_t from, std::int64_t to) {
    if (to - from <= limit_ns || to <= begin_ns || from >= end_ns) return;
    ++gaps;
    time_ns += std::min(to, end_ns) - std::max(from, begin_ns);
  }
};

template <class Frames>
class Window {
 public:
  Window(Pass<Frames> pass, const TimeModel& clock, const GapCount& count = {})
      : gaps(count), pass_(std::move(pass)), clock_(&clock) {}

  /// After it, `rows` hold all samples within [from, to] and, where the stream has them, `reach`
  /// more on either side. `from` and `to` (ns on the take's axis) rise from call to call.
  Result<void> move(std::int64_t from, std::int64_t to, std::size_t reach) {
    while (!ended_ && !reaches(to, reach)) {
      KA_TRY(pull());
      forget(from, reach);
    }
    drop_before(from, reach);
    return {};
  }

  /// After it, `rows` begin at the first sample not before `from` and are at least `count`, where
  /// the stream has them.
  Result<void> fill(std::int64_t from, std::size_t count) {
    for (;;) {
      drop_before(from, 0);
      if (ended_ || time_ns.size() >= count) return {};
      KA_TRY(pull());
    }
  }

  Frames rows;                        // stamps as the device gave them
  std::vector<std::int64_t> time_ns;  // [rows] on the take's axis, strictly rising
  GapCount gaps;                      // in what was pulled so far

 private:
  void drop_before(std::int64_t from, std::size_t reach) {
    const auto inside = static_cast<std::size_t>(
        std::lower_bound(time_ns.begin(), time_ns.end(), from) - time_ns.begin());
    const std::size_t drop = inside - std::min(inside, reach);
    drop_front(rows, drop);
    time_ns.erase(time_ns.begin(), time_ns.begin() + static_cast<std::ptrdiff_t>(drop));
  }

  bool reaches(std::int64_t to, std::size_t reach) const {
    return time_ns.size() > reach && time_ns[time_ns.size() - 1 - reach] >= to;
  }

  /// Drops while pulling, where it is worth the move: a stretch without rows may be long.
  void forget(std::int64_t from, std::size_t reach) {
    const std::size_t half = time_ns.size() / 2;
    if (half > reach && time_ns[half] < from) drop_before(from, reach);
  }

  /// Until the last row can't be taken back any more.
  Result<void> pull() {
    do {
      if (!KA_TRY(pass_(block_))) {
        ended_ = true;
        return {};
      }
      take_block();
    } while (rule_.pending());
    return {};
  }

  void take_block() {
    std::size_t first = 0, i = 0;  // rows [first, i) are kept and not yet appended
    for (; i < block_.size(); ++i) {
      const StampFate fate = rule_.judge(block_.stamps[i]);
      if (fate == StampFate::kept) {
        add_time(block_.stamps[i]);
        continue;
      }
      append_rows(rows, block_, first, i - first);
      first = i + 1;
      if (fate != StampFate::replaces) continue;
      take_back();
      add_time(block_.stamps[i]);
      first = i;
    }
    append_rows(rows, block_, first, i - first);
  }

  void add_time(Time stamp) {
    const std::int64_t t = to_ns(take_time(*clock_, stamp));
    gaps_before_ = gaps;
    if (last_ns_) gaps.add(*last_ns_, t);
    before_ns_ = last_ns_;
    last_ns_ = t;
    time_ns.push_back(t);
  }

  void take_back() {
    drop_last(rows);
    time_ns.pop_back();
    gaps = gaps_before_;
    last_ns_ = before_ns_;
  }

  Pass<Frames> pass_;
  const TimeModel* clock_;
  Frames block_;
  StampRule rule_;
  std::optional<std::int64_t> last_ns_, before_ns_;  // of the rows added, kept or forgotten
  GapCount gaps_before_;                             // without the last row
  bool ended_ = false;
};

}  // namespace kinalign
