// SPDX-License-Identifier: Apache-2.0
// The samples of a stream around the rows that are being made. A stream is read block by block. The
// stream may also be the reference, whose stamps are the grid. Three kinds of samples are dropped:
// samples whose time does not rise (motion/stamps.h), samples that were stamped late
// (resample/arrival_lines.h), and samples that no later row needs. Rows and counts do not depend on
// the size of the blocks.
#pragma once

#include "kinalign/motion/stamps.h"
#include "kinalign/resample/arrival_lines.h"
#include "kinalign/take/recording.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

// These functions append rows of one block to another, drop rows at the front, and drop the last
// row. The number of values per row is computed from the sizes of the arrays. They exist for all
// three kinds of blocks.
template <class Frames>
void append_rows(Frames& to, const Frames& from, std::size_t first, std::size_t count);
template <class Frames>
void drop_front(Frames& rows, std::size_t count);
template <class Frames>
void drop_last(Frames& rows);

// The columns of a row that were seen. A column is a joint, a node, or the whole body of a
// skeleton.
inline std::size_t columns(const ClipFrames&) { return 1; }
inline std::size_t columns(const PointFrames& rows) { return rows.state.size() / rows.size(); }
inline std::size_t columns(const ImuSamples& rows) { return rows.valid.size() / rows.size(); }
inline bool seen(const ClipFrames&, std::size_t) { return true; }
inline bool seen(const PointFrames& rows, std::size_t cell) {
  return rows.state[cell] != Tracking::missing;
}
inline bool seen(const ImuSamples& rows, std::size_t cell) { return rows.valid[cell] != 0; }
inline void make_unseen(ClipFrames&, std::size_t) {}
inline void make_unseen(PointFrames& rows, std::size_t cell) {
  rows.state[cell] = Tracking::missing;
}
inline void make_unseen(ImuSamples& rows, std::size_t cell) { rows.valid[cell] = 0; }

template <class Frames>
bool any_seen(const Frames& rows, std::size_t row) {
  const std::size_t width = columns(rows);
  for (std::size_t cell = row * width; cell < (row + 1) * width; ++cell) {
    if (seen(rows, cell)) return true;
  }
  return false;
}

/// Greatest time to a raw sample that is measured. Without this limit, a column that was not seen
/// for hours would require hours of samples in memory.
constexpr std::int64_t farthest_nearest_ns = 10'000'000'000;

/// The samples around a row that are needed: in each column `knots` seen samples or those up to a
/// gap, and the nearest sample within farthest_nearest_ns.
struct Reach {
  std::size_t knots = 0;
  std::int64_t gap_ns = 0;

  /// Returns whether a sample is too far away to be needed. `distance` is the time from the last of
  /// the `found` knots or, if there is none, from the row.
  bool ended(std::int64_t distance, std::size_t found) const {
    return distance > (found == 0 ? std::max(gap_ns, farthest_nearest_ns) : gap_ns);
  }
};

/// Counts the gaps within a time span: times in which nothing was seen.
struct GapCount {
  std::int64_t limit_ns = 0;                              // longer times count as gaps
  std::int64_t begin_ns = INT64_MIN, end_ns = INT64_MAX;  // the take's span; default: unlimited
  std::uint64_t gaps = 0;
  std::int64_t time_ns = 0;  // sum of the gaps' lengths within the time span

  /// Adds a time without samples. Time after the take's end is not counted, because it is arbitrary
  /// how far the stream was read there.
  void add(std::int64_t from, std::int64_t to) {
    to = std::min(to, end_ns);
    if (from >= to || to - from <= limit_ns || to <= begin_ns) return;
    ++gaps;
    time_ns += to - std::max(from, begin_ns);
  }
};

/// Counts of a stream so far, up to the take's end (gaps.end_ns).
struct StreamCounts {
  GapCount gaps;
  std::uint64_t held_back = 0;  // samples dropped because the next sample followed too soon
  /// Counts over all rising stamps. For a resampled stream, `near` is the number of dropped
  /// samples.
  Arrivals arrivals;
};

/// Stores the samples of one pass around the rows that are being made. `rows` and `time_ns` always
/// have the same number of rows. The newest rows may still be dropped, so move() reads on until the
/// needed rows are final.
template <class Frames>
class Window {
 public:
  Window(Pass<Frames> pass, const TimeModel& clock, const GapCount& count = {}, TakenStep step = {})
      : pass_(std::move(pass)),
        clock_(&clock),
        lines_(step),
        near_counts_(step.role == Role::reference),
        gaps_(count) {}

  /// Reads until `rows` contains all samples within [from, to] and, if the stream has them, those
  /// within `reach` on either side. `from` and `to` (ns on the take's time axis) must rise from
  /// call to call.
  Result<void> move(std::int64_t from, std::int64_t to, const Reach& reach) {
    // A long time without rows may be read here; forget() limits the memory.
    while (!ended_ && !reaches(to, reach)) {
      KA_TRY(pull());
      forget(from, reach);
    }
    drop_before(from, reach);
    return {};
  }

  /// Reads until `rows` begins at the first sample at or after `from` and contains at least `count`
  /// samples, if the stream has them.
  Result<void> fill(std::int64_t from, std::size_t count) {
    for (;;) {
      drop(first_not_before(from));
      if (ended_ || time_ns.size() >= count) return {};
      KA_TRY(pull());
    }
  }

  Frames rows;                        // with the device's stamps
  std::vector<std::int64_t> time_ns;  // [rows] ns on the take's axis, strictly rising

  StreamCounts counts() const {
    StreamCounts out{gaps_, held_back_, at_end_ ? *at_end_ : lines_.result()};
    const bool has_end = gaps_.end_ns != INT64_MAX;
    // Nothing was seen between the last seen row and the take's end.
    if (has_end && last_seen_) out.gaps.add(*last_seen_, gaps_.end_ns);
    if (!near_counts_) out.arrivals.near = held_back_;
    return out;
  }

 private:
  std::size_t first_not_before(std::int64_t t) const {
    return static_cast<std::size_t>(std::lower_bound(time_ns.begin(), time_ns.end(), t) -
                                    time_ns.begin());
  }

  void drop(std::size_t count) {
    drop_front(rows, count);
    time_ns.erase(time_ns.begin(), time_ns.begin() + static_cast<std::ptrdiff_t>(count));
  }

  /// Drops the samples before `from` that are outside `reach` in every column.
  void drop_before(std::int64_t from, const Reach& reach) {
    const std::size_t inside = first_not_before(from);
    std::size_t first = inside;
    const std::size_t width = inside > 0 ? columns(rows) : 0;
    for (std::size_t c = 0; c < width; ++c) {
      std::size_t knots = 0;
      // Stamp of the last knot found.
      std::int64_t last = from;
      for (std::size_t t = inside; t-- > 0 && knots < reach.knots;) {
        if (reach.ended(last - time_ns[t], knots)) break;
        if (!seen(rows, t * width + c)) continue;
        ++knots;
        last = time_ns[t];
        first = std::min(first, t);
      }
    }
    drop(first);
  }

  /// Returns whether the samples within `reach` after `to` are present in each column.
  bool reaches(std::int64_t to, const Reach& reach) const {
    const std::size_t end = sure();
    if (end == 0 || time_ns[end - 1] < to) return false;
    const std::size_t begin = first_not_before(to), width = columns(rows);
    for (std::size_t c = 0; c < width; ++c) {
      std::size_t knots = 0, t = begin;
      std::int64_t last = to;
      for (; t < end && knots < reach.knots; ++t) {
        if (reach.ended(time_ns[t] - last, knots)) break;
        if (!seen(rows, t * width + c)) continue;
        ++knots;
        last = time_ns[t];
      }
      if (t == end && knots < reach.knots) return false;
    }
    return true;
  }

  /// Returns the number of rows that no later sample can show to be delayed.
  std::size_t sure() const {
    if (ended_ || time_ns.empty()) return time_ns.size();
    const auto open = lines_.open_since(time_ns.back());
    return open ? first_not_before(*open) : time_ns.size();
  }

  /// Drops rows during reading, when at least half of them are old. Otherwise a long time without
  /// rows would fill the memory. Samples for later rows from `from` on are not dropped.
  void forget(std::int64_t from, const Reach& reach) {
    if (time_ns.empty() || time_ns[time_ns.size() / 2] >= from) return;
    drop_before(std::min(from, time_ns.back()), reach);
  }

  /// Reads blocks until the last row is final with respect to its stamp.
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

  /// Appends the accepted samples of a block. Consecutive accepted rows are appended together.
  void take_block() {
    std::size_t first = 0, i = 0;  // rows [first, i) are accepted but not appended yet
    const auto flush = [&](std::size_t next) {
      append_rows(rows, block_, first, i - first);
      first = next;
    };
    for (; i < block_.size(); ++i) {
      // Stamps are judged on the take's time axis, because the device's clock may step.
      const Time at = take_time(*clock_, block_.stamps[i]);
      const StampFate fate = rule_.judge(at);
      if (fate != StampFate::kept && fate != StampFate::replaces) {
        flush(i + 1);
        continue;
      }
      const std::int64_t t = to_ns(at);
      // The previous row had a wrong stamp. It must be in `rows` before it can be removed.
      if (fate == StampFate::replaces) {
        flush(i);
        take_back();
      }
      // A row in which nothing was seen is stored, but it belongs to no line and ends no gap.
      if (!look(i)) {
        time_ns.push_back(t);
        continue;
      }
      const auto line = lines_.line_of(t, seen_);
      const auto late = line ? lines_.shown_late(*line, t) : std::nullopt;
      if (late) {
        flush(i);
        leave_out(*late);
        lines_.leave_out(*line);
      } else if (line) {
        lines_.keep(*line);
      }
      time_ns.push_back(t);
      see(t, line);
    }
    flush(i);
  }

  /// Fills `seen_` with the columns of row i of the block. Returns whether any column was seen.
  bool look(std::size_t i) {
    const std::size_t width = columns(block_);
    seen_.resize(width);
    bool any = false;
    for (std::size_t c = 0; c < width; ++c) {
      seen_[c] = seen(block_, i * width + c) ? 1 : 0;
      any = any || seen_[c] != 0;
    }
    return any;
  }

  /// Drops the row at `late`, because the row with the columns `seen_` shows that it was delayed.
  /// Only the columns that both rows have are dropped. Rows of other lines may follow the late row.
  void leave_out(std::int64_t late) {
    if (late <= gaps_.end_ns) ++held_back_;
    const std::size_t row = first_not_before(late), width = seen_.size();
    // No later row needed the late row, so it was already dropped.
    if (row == time_ns.size() || time_ns[row] != late) return;
    // The whole row is dropped only if it has no other column and no seen row follows.
    bool whole = late == last_seen_;
    for (std::size_t c = 0; c < width && whole; ++c) {
      whole = seen_[c] != 0 || !seen(rows, row * width + c);
    }
    if (whole) {
      while (!time_ns.empty() && time_ns.back() >= late) drop_last_row();
      restore();
      return;
    }
    for (std::size_t c = 0; c < width; ++c) {
      if (seen_[c] != 0) make_unseen(rows, row * width + c);
    }
  }

  /// Removes the last row, because its stamp was wrong.
  void take_back() {
    const bool was_seen = last_seen_ == time_ns.back();
    drop_last_row();
    if (!was_seen) return;
    if (before_[0].in_line) lines_.take_back();
    restore();
    // The removed row may have been the first row after the take's end.
    if (last_seen_ <= gaps_.end_ns) at_end_.reset();
  }

  void drop_last_row() {
    drop_last(rows);
    time_ns.pop_back();
  }

  /// Records that the row at `t` has the columns `seen_`.
  void see(std::int64_t t, std::optional<std::size_t> line) {
    before_[1] = before_[0];
    before_[0] = {last_seen_, gaps_, line.has_value()};
    if (last_seen_) gaps_.add(*last_seen_, t);
    last_seen_ = t;
    if (!at_end_ && t > gaps_.end_ns) at_end_ = lines_.result();
    if (line) lines_.add(*line, t, seen_);
  }

  void restore() {
    last_seen_ = before_[0].last_seen;
    gaps_ = before_[0].gaps;
    before_[0] = before_[1];
  }

  Pass<Frames> pass_;
  const TimeModel* clock_;
  Frames block_;
  std::vector<std::uint8_t> seen_;  // [columns] of the row that is being processed
  StampRule rule_;
  ArrivalLines lines_;
  std::optional<Arrivals> at_end_;  // lines_.result() before the first row after the take's end
  bool near_counts_;                // true for the reference, whose delayed rows are not dropped
  GapCount gaps_;
  std::uint64_t held_back_ = 0;
  std::optional<std::int64_t> last_seen_;  // stamp of the newest row in which anything was seen
  /// The states before the newest seen row [0] and before the row preceding it [1]. A row with a
  /// wrong stamp may be removed, and the preceding row may then be found late.
  struct Before {
    std::optional<std::int64_t> last_seen;
    GapCount gaps;
    bool in_line = false;  // the row was added to a line
  };
  std::array<Before, 2> before_;
  bool ended_ = false;
};

}  // namespace kinalign
