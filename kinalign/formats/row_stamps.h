// SPDX-License-Identifier: Apache-2.0
// Stamps of a table's rows: from a column, exact to the nanosecond, or from a rate.
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

constexpr std::int64_t furthest_stamp_ns = 4'000'000'000'000'000'000;  // see formats/reader.h

/// How a time column counts.
struct TimeScale {
  std::int64_t unit_ns = 1;
  std::int64_t epoch_s = 0;  // the file's zero before 1970: .NET counts from year 1
};

constexpr std::int64_t year_1_s = 62'135'596'800;  // from 0001-01-01 to 1970-01-01

/// "1642700852075.903" at 1 ms -> ns, by integers; with an exponent through a double. Empty where
/// that is no number or lies outside +-4e18 ns.
std::optional<std::int64_t> parse_stamp(std::string_view text, TimeScale scale);

/// ns -> "-12.345": seconds, exact, without zeros at the end. parse_stamp reads the same ns again.
std::string seconds_text(std::int64_t ns);

/// Index and rate -> ns from the first row.
std::int64_t stamp_at_rate(std::uint64_t index, double rate_hz);

/// Gives the rows of one file their stamps in order. A column that does not move is noticed on the
/// first rows, so until settled() the rows have to be held back.
class RowStamps {
 public:
  /// Rows that may share the first stamp before a column counts as stuck.
  static constexpr std::uint64_t patience = 32;

  /// `rate_hz` is used where there is no column or where that is stuck. `start_ns` moves all
  /// stamps so that the first row has it.
  RowStamps(bool column, double rate_hz, std::optional<std::int64_t> start_ns);

  /// The next row's stamp; `ns` is what the column says (anything where there is none). Fails,
  /// without a place, outside +-4e18 ns.
  Result<Time> next(std::int64_t ns);

  /// The first rows' stamps are final.
  bool settled() const { return settled_; }
  /// The file has ended.
  void settle();
  /// Gives the rows held back, which are the first ones, their final stamps.
  void restamp(std::vector<Time>& held) const;

  /// The column never moved.
  bool stuck() const { return stuck_; }
  /// Stamps are counted by the rate.
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
  std::int64_t first_ = 0;  // as in the file
  std::int64_t shift_ = 0;
};

/// What a reader says of a stuck column.
Finding stuck_finding(std::string_view file, const RowStamps& stamps);

}  // namespace kinalign
