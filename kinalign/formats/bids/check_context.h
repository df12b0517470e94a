// SPDX-License-Identifier: Apache-2.0
// State shared by the parts of the checker: the listing, the findings and functions that read
// files.
#pragma once

#include "kinalign/formats/bids/check.h"
#include "kinalign/formats/bids/names.h"
#include "kinalign/formats/bids/tsv_table.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// The line of a row of a table; line 1 has the names of the columns.
inline std::int64_t line_of_row(std::size_t row) { return static_cast<std::int64_t>(row) + 2; }

/// Every function adds its faults to `findings` and goes on, so one run reports all of them.
class BidsCheck {
 public:
  explicit BidsCheck(const BidsListing& given) : listing(given) {}

  const BidsListing& listing;
  Findings findings;

  /// Warnings are for what BIDS recommends, errors for what it requires.
  void error(const std::string& path, std::string expected, std::string found,
             std::int64_t line = 0);
  void warning(const std::string& path, std::string expected, std::string found,
               std::int64_t line = 0);

  /// Adds the error of a file that can't be read.
  void unreadable(const std::string& path, Error what);
  /// Adds an error if the row does not have a cell for each column.
  bool is_whole_row(const std::string& path, const TsvTable& table, std::size_t row);

  /// The content of a file of at most 16 MiB. If the file can't be read, that becomes an error and
  /// the result is empty.
  std::optional<std::string> text_of(const std::string& path);
  std::optional<TsvTable> table_of(const std::string& path);
  std::optional<nlohmann::ordered_json> json_of(const std::string& path);

  /// Files with the given ending that also apply to `path` by BIDS' inheritance principle. They lie
  /// in its folder or above it and have no entity that `path` lacks. The nearest file comes last.
  std::vector<std::string> inherited(const std::string& path, std::string_view ending) const;
};

/// Checks the files of the tracking system to which this motion.tsv belongs.
void check_bids_system(const std::string& motion_tsv, BidsCheck& check);
/// Results of check_bids_rows(); latencies are those of the first and the last row that has one.
/// Compared with the rates and the duration that motion.json states.
struct BidsRowsSummary {
  std::uint64_t rows = 0, latencies = 0;
  std::optional<double> first_latency_s, last_latency_s;
};
struct BidsChannel;
/// Checks a motion.tsv against its channels: number of cells, numbers, rising latencies, lengths of
/// quaternions.
BidsRowsSummary check_bids_rows(const std::string& path, const std::vector<BidsChannel>& channels,
                                BidsCheck& check);

}  // namespace kinalign
