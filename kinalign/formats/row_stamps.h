// SPDX-License-Identifier: Apache-2.0
// Stamps for the rows of a table: from a time column, exact to the nanosecond, or from a rate.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/manifest.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

constexpr std::int64_t largest_stamp_ns = 4'000'000'000'000'000'000;  // see formats/reader.h

/// Unit and zero of a time column.
struct TimeScale {
  std::int64_t unit_ns = 1;
  std::int64_t epoch_s = 0;  // the column's zero, in seconds before 1970: .NET counts from year 1
};

constexpr std::int64_t year_1_s = 62'135'596'800;  // from 0001-01-01 to 1970-01-01

/// "1642700852075.903" at 1 ms -> ns, in integers; a number with an exponent goes through a double.
/// Empty if `text` is no number or the stamp lies outside +-4e18 ns.
std::optional<std::int64_t> parse_stamp(std::string_view text, TimeScale scale);

/// ns -> "-12.345": seconds, exact, without zeros at the end. parse_stamp reads the same ns back.
std::string seconds_text(std::int64_t ns);

/// Time of row `index` in ns after row 0, at `rate_hz`.
std::int64_t stamp_at_rate(std::uint64_t index, double rate_hz);

/// Gives the rows of one file their stamps, in order. A time column that never moves is found only
/// after several rows. The caller must keep the rows until settled().
class RowStamps {
 public:
  /// A column counts as stuck after so many rows with the first stamp.
  static constexpr std::uint64_t patience = 32;

  /// `rate_hz` is used if there is no time column or if it is stuck. `start_ns` shifts all stamps
  /// so that the first row gets it.
  RowStamps(bool column, double rate_hz, std::optional<std::int64_t> start_ns);

  /// The stamp of the next row. `ns` is the value of the time column, and ignored without one.
  /// Fails, without a place, outside +-4e18 ns.
  Result<Time> next(std::int64_t ns);

  /// True once the stamps of the first rows are final.
  bool settled() const { return settled_; }
  /// Call at the end of the file: decides on a file with few rows.
  void settle();
  /// Replaces the stamps of the rows that the caller kept, which are the first ones, by their final
  /// stamps.
  void restamp(std::vector<Time>& held) const;

  /// True if the time column never moved.
  bool stuck() const { return stuck_; }
  /// True if the stamps come from the rate.
  bool counted() const { return !column_ || (stuck_ && rate_hz_ > 0.0); }
  double rate_hz() const { return rate_hz_; }
  std::uint64_t rows() const { return rows_; }

 private:
  bool column_;
  double rate_hz_;
  std::optional<std::int64_t> start_ns_;
  bool settled_;
  bool stuck_ = false;
  std::uint64_t rows_ = 0;
  std::int64_t first_ = 0;  // stamp of the first row, as in the file
  /// ns added to each stamp of the file, so that the first row gets the start
  std::int64_t shift_ = 0;
};

/// The warning about a time column that never moves.
Finding stuck_finding(std::string_view file, const RowStamps& stamps);

}  // namespace kinalign
