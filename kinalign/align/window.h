// SPDX-License-Identifier: Apache-2.0
// The samples of a stream around the rows being made: a stream is pulled block by block, stamps
// that do not rise are dropped, and what lies behind is forgotten.
#pragma once

#include "kinalign/take/recording.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

// Rows first.. of one block appended to another, and rows dropped from the front. The number of
// values in a row follows from the arrays' sizes.
void append_rows(ClipFrames& to, const ClipFrames& from, std::size_t first, std::size_t count);
void append_rows(PointFrames& to, const PointFrames& from, std::size_t first, std::size_t count);
void append_rows(ImuSamples& to, const ImuSamples& from, std::size_t first, std::size_t count);
void drop_front(ClipFrames& rows, std::size_t count);
void drop_front(PointFrames& rows, std::size_t count);
void drop_front(ImuSamples& rows, std::size_t count);

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
    while (!ended_ && !reaches(to, reach)) KA_TRY(pull());
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

  Result<void> pull() {
    if (!KA_TRY(pass_(block_))) {
      ended_ = true;
      return {};
    }
    std::size_t i = 0;
    while (i < block_.size()) {
      if (any_ && block_.stamps[i] <= last_) {
        ++i;
        continue;
      }
      const std::size_t first = i;
      while (i < block_.size() && (!any_ || block_.stamps[i] > last_)) {
        any_ = true;
        last_ = block_.stamps[i++];
        const std::int64_t t = to_ns(take_time(*clock_, last_));
        if (!time_ns.empty()) gaps.add(time_ns.back(), t);
        time_ns.push_back(t);
      }
      append_rows(rows, block_, first, i - first);
    }
    return {};
  }

  Pass<Frames> pass_;
  const TimeModel* clock_;
  Frames block_;
  Time last_{};
  bool any_ = false, ended_ = false;
};

}  // namespace kinalign
