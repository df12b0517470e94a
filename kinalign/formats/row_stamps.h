// SPDX-License-Identifier: Apache-2.0
// Gives the rows of a table their stamps, from a time column (exact to the nanosecond) or from a
// rate.
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

/// The unit and the zero of a time column.
struct TimeScale {
  std::int64_t unit_ns = 1;
  std::int64_t epoch_s = 0;  // zero of the column, in seconds before 1970; .NET counts from year 1
};

constexpr std::int64_t year_1_s = 62'135'596'800;  // from 0001-01-01 to 1970-01-01

/// Converts a time in a file to ns, for example "1642700852075.903" in ms. Integers are used,
/// except for a number with an exponent. The result is empty if `text` is not a number, or if the
/// stamp is outside +-4e18 ns.
std::optional<std::int64_t> parse_stamp(std::string_view text, TimeScale scale);

/// Converts ns to seconds exactly, without zeros at the end: "-12.345". parse_stamp() converts the
/// text back to the same ns.
std::string seconds_text(std::int64_t ns);

/// The time of row `index` after row 0 at the rate `rate_hz`, ns.
std::int64_t stamp_at_rate(std::uint64_t index, double rate_hz);

/// Gives the rows of one file their stamps, in order. Several rows are needed to find that a time
/// column never changes. The caller must therefore keep the rows until settled().
class RowStamps {
 public:
  /// After so many rows with the first stamp, the time column counts as stuck.
  static constexpr std::uint64_t patience = 32;

  /// `rate_hz` is used if there is no time column or if it is stuck. If `start_ns` is given, all
  /// stamps are shifted so that the first row has this stamp.
  RowStamps(bool column, double rate_hz, std::optional<std::int64_t> start_ns);

  /// The stamp of the next row. `ns`: the value of the time column, which is ignored if there is no
  /// time column. Fails outside +-4e18 ns. The caller adds file and line to the error.
  Result<Time> next(std::int64_t ns);

  /// True if the stamps of the first rows are final.
  bool settled() const { return settled_; }
  /// Call this at the end of the file. In a file with few rows, it decides whether the time column
  /// counts as stuck.
  void settle();
  /// Replaces the stamps of the rows that the caller kept by their final stamps. These are the
  /// first rows.
  void restamp(std::vector<Time>& held) const;

  /// True if the time column never changed.
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
  /// The difference between the stamps and those in the file, ns. It moves the first row to
  /// `start_ns`.
  std::int64_t shift_ = 0;
};

/// The warning about a time column that never changes.
Finding stuck_finding(std::string_view file, const RowStamps& stamps);

}  // namespace kinalign
