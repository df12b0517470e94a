// SPDX-License-Identifier: Apache-2.0
// Which samples of a stream were held back on their way, where several nodes or bodies write rows
// of their own into it.
#pragma once

#include "kinalign/motion/arrivals.h"
#include "kinalign/resample/taken_step.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// Rows of one node come near another's, without having been held back. So a row is only judged by
/// its own line: the latest one whose last row shows something that it shows too. A row of which
/// nothing was seen for long goes on in a line that has ended, or begins one.
class ArrivalLines {
 public:
  explicit ArrivalLines(TakenStep step)
      : step_(step), near_ns_(step.role == Role::resampled ? step.ns / near_share : 0) {}

  /// The line of a row at `t` (ns on the take's axis, rising) that shows some columns, not 0 in
  /// `seen`. None beyond 64 lines.
  std::optional<std::size_t> line_of(std::int64_t t, std::span<const std::uint8_t> seen);

  /// The last row of a line, if it was held back: the next one at `t` comes so soon behind it. Of a
  /// whole stretch of such rows one a step stays.
  std::optional<std::int64_t> shown_late(std::size_t line, std::int64_t t) const;

  /// After shown_late: that row is left out, or stays and ends a stretch of those left out.
  void leave_out(std::size_t line);
  void keep(std::size_t line) { lines_[line].late_since.reset(); }

  void add(std::size_t line, std::int64_t t, std::span<const std::uint8_t> seen);
  /// The row added last was no sample.
  void take_back();

  /// The first row that one behind `t` may still show to have been held back.
  std::optional<std::int64_t> open_since(std::int64_t t) const;

  /// Of all lines; `near` as counted of the reference too.
  Arrivals result() const;

 private:
  static constexpr std::size_t most_lines = 64;
  using Columns = std::vector<std::uint8_t>;

  struct Line {
    ArrivalSurveyor arrivals;
    std::optional<std::int64_t> t;  // of its last row
    Columns seen;                   // in that
    std::optional<std::int64_t> late_since;
  };
  /// A line as it was without its last row.
  struct Before {
    std::size_t line = 0;
    std::optional<std::int64_t> t;
    Columns seen;
  };

  void restore();

  TakenStep step_;
  std::int64_t near_ns_;
  std::vector<Line> lines_;
  /// Without the row added last, and without the one before: a wild stamp is taken back, and then
  /// the one in front of it may be late.
  std::array<Before, 2> before_;
};

}  // namespace kinalign
