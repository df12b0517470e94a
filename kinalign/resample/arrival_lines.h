// SPDX-License-Identifier: Apache-2.0
// Finds delayed samples in a stream into which several nodes or bodies write their own rows.
#pragma once

#include "kinalign/motion/arrivals.h"
#include "kinalign/resample/taken_step.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// Rows of different nodes may be close in time without a delay. A row is therefore compared only
/// within its own line: the line with the latest last row that shows some of the same columns. A
/// row whose columns were not seen for a long time continues a line that has ended, or begins a new
/// one.
class ArrivalLines {
 public:
  explicit ArrivalLines(TakenStep step)
      : step_(step), near_ns_(step.role == Role::resampled ? step.ns / near_share : 0) {}

  /// The line of a row at `t` (ns on the take's axis, rising) whose columns are those not 0 in
  /// `seen`. Empty if 64 lines exist.
  std::optional<std::size_t> line_of(std::int64_t t, std::span<const std::uint8_t> seen);

  /// The stamp of a line's last row if the next row at `t` shows that it was delayed. In a long
  /// stretch of such rows one row per step is kept.
  std::optional<std::int64_t> shown_late(std::size_t line, std::int64_t t) const;

  /// After shown_late(): that row is dropped, or kept (keep()), which ends a stretch of dropped
  /// rows.
  void leave_out(std::size_t line);
  void keep(std::size_t line) { lines_[line].late_since.reset(); }

  void add(std::size_t line, std::int64_t t, std::span<const std::uint8_t> seen);
  /// Removes the row added last, because it was not a valid sample.
  void take_back();

  /// The first row that a row after `t` may still show to be delayed.
  std::optional<std::int64_t> open_since(std::int64_t t) const;

  /// The counts of all lines. For the reference, `near` is counted, too.
  Arrivals result() const;

 private:
  static constexpr std::size_t most_lines = 64;
  using Columns = std::vector<std::uint8_t>;

  struct Line {
    ArrivalSurveyor arrivals;
    std::optional<std::int64_t> t;  // stamp of its last row
    Columns seen;                   // columns of its last row
    /// The stamp of the first row of a stretch of dropped rows; empty outside of one.
    std::optional<std::int64_t> late_since;
  };
  /// The state of a line before its last row.
  struct Before {
    std::size_t line = 0;
    std::optional<std::int64_t> t;
    Columns seen;
  };

  void restore();

  // lines_ only grows, and a line keeps its place, so callers may hold its index.
  TakenStep step_;
  /// near_ns_ is 0 for the reference and for an unknown step; then no row is ever shown to be late.
  std::int64_t near_ns_;
  std::vector<Line> lines_;
  /// The states before the last row and before the one before it. A row with a wrong stamp may be
  /// removed, and then the row before it may turn out to be late.
  /// [0] is the newer state. take_back() or leave_out() uses it up, and [1] takes its place.
  std::array<Before, 2> before_;
};

}  // namespace kinalign
