// SPDX-License-Identifier: Apache-2.0
// The state that all parts of the checker share: the listing, the findings, and functions that read
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

/// The line number of a row in a table. Line 1 contains the names of the columns.
inline std::int64_t line_of_row(std::size_t row) { return static_cast<std::int64_t>(row) + 2; }

/// Collects findings. Every check adds its findings and goes on, so that one run reports all
/// faults.
class BidsCheck {
 public:
  explicit BidsCheck(const BidsListing& given) : listing(given) {}

  const BidsListing& listing;
  Findings findings;

  /// Errors concern what BIDS requires, and warnings what BIDS recommends.
  void error(const std::string& path, std::string expected, std::string found,
             std::int64_t line = 0);
  void warning(const std::string& path, std::string expected, std::string found,
               std::int64_t line = 0);

  /// Adds an error for a file that can't be read.
  void unreadable(const std::string& path, Error what);
  /// Returns true if the row has a cell for each column. Otherwise adds an error.
  bool is_whole_row(const std::string& path, const TsvTable& table, std::size_t row);

  /// The content of a file of at most 16 MiB. If the file can't be read, an error is added and the
  /// result is empty.
  std::optional<std::string> text_of(const std::string& path);
  std::optional<TsvTable> table_of(const std::string& path);
  std::optional<nlohmann::ordered_json> json_of(const std::string& path);

  /// Files with the given ending that also apply to `path` by the inheritance principle of BIDS.
  /// They are in the folder of `path` or above. They have no entity that `path` lacks. The nearest
  /// file comes last.
  std::vector<std::string> inherited(const std::string& path, std::string_view ending) const;
};

/// Checks all files of the tracking system to which this motion.tsv belongs.
void check_bids_system(const std::string& motion_tsv, BidsCheck& check);
/// The results of check_bids_rows(), which are compared with rates and duration in motion.json. The
/// latencies are those of the first and the last row with a latency.
struct BidsRowsSummary {
  std::uint64_t rows = 0, latencies = 0;
  std::optional<double> first_latency_s, last_latency_s;
};
struct BidsChannel;
/// Checks a motion.tsv against its channels: number of cells, numbers, rising latencies, and
/// lengths of quaternions.
BidsRowsSummary check_bids_rows(const std::string& path, const std::vector<BidsChannel>& channels,
                                BidsCheck& check);

}  // namespace kinalign
