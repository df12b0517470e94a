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

/// Groups the rows of a stream into lines. Rows of different nodes may be close in time without a
/// delay, so a row is compared only with rows of its own line. A column is a joint or a node. A row
/// belongs to the line whose last row has one of the same columns; if several lines qualify, the
/// newest is used. If none does, the row continues a line that has ended, or begins a new line.
class ArrivalLines {
 public:
  explicit ArrivalLines(TakenStep step)
      : step_(step), near_ns_(step.role == Role::resampled ? step.ns / near_share : 0) {}

  /// Returns the line of a row at `t` (ns on the take's time axis, rising). The row's columns are
  /// those that are not 0 in `seen`. Empty if 64 lines exist and none fits.
  std::optional<std::size_t> line_of(std::int64_t t, std::span<const std::uint8_t> seen);

  /// Returns the stamp of the line's last row if the next row, at `t`, shows that the last row was
  /// delayed. In a long series of such rows, one row per step is accepted.
  std::optional<std::int64_t> shown_late(std::size_t line, std::int64_t t) const;

  /// Call after shown_late(): leave_out() if the row is dropped, keep() if it is accepted. keep()
  /// ends a series of dropped rows.
  void leave_out(std::size_t line);
  void keep(std::size_t line) { lines_[line].late_since.reset(); }

  void add(std::size_t line, std::int64_t t, std::span<const std::uint8_t> seen);
  /// Removes the newest row, because its stamp was wrong.
  void take_back();

  /// Returns the stamp of the first row that a row after `t` may still show to be delayed.
  std::optional<std::int64_t> open_since(std::int64_t t) const;

  /// The counts of all lines. For the reference (the stream whose stamps are the grid), `near` is
  /// counted too: late rows that were not dropped.
  Arrivals result() const;

 private:
  static constexpr std::size_t most_lines = 64;
  using Columns = std::vector<std::uint8_t>;

  struct Line {
    ArrivalSurveyor arrivals;
    std::optional<std::int64_t> t;  // stamp of its last row
    Columns seen;                   // columns of its last row
    /// The stamp of the first row of the present series of dropped rows; empty outside a series.
    std::optional<std::int64_t> late_since;
  };
  /// The state of a line before its newest row was added.
  struct Before {
    std::size_t line = 0;
    std::optional<std::int64_t> t;
    Columns seen;
  };

  void restore();

  // Lines are never removed, so their indices stay valid.
  TakenStep step_;
  /// 0 for the reference and for an unknown step; no row is then shown to be late.
  std::int64_t near_ns_;
  std::vector<Line> lines_;
  /// The states before the newest row [0] and before the row preceding it [1]. A row with a wrong
  /// stamp may be removed, and the preceding row may then be found late. take_back() and
  /// leave_out() use [0] and replace it by [1].
  std::array<Before, 2> before_;
};

}  // namespace kinalign
