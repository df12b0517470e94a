// SPDX-License-Identifier: Apache-2.0
// What the parts of the checker share: the listing, the findings, and files read once.
#pragma once

#include "kinalign/formats/bids/check.h"
#include "kinalign/formats/bids/names.h"
#include "kinalign/formats/bids/tsv_table.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

class BidsCheck {
 public:
  explicit BidsCheck(const BidsListing& given) : listing(given) {}

  const BidsListing& listing;
  Findings findings;

  void error(const std::string& path, std::string expected, std::string found,
             std::int64_t line = 0);
  void warning(const std::string& path, std::string expected, std::string found,
               std::int64_t line = 0);

  /// A whole file of at most 16 MiB; where it can't be read, that is an error, and nothing
  /// returned.
  std::optional<std::string> text_of(const std::string& path);
  std::optional<TsvTable> table_of(const std::string& path);
  std::optional<nlohmann::ordered_json> json_of(const std::string& path);

  /// Files with that ending that hold for the file `path` by BIDS' rule of inheritance: in its
  /// folder or above it, with no entity that `path` does not have. The nearest comes last.
  std::vector<std::string> inherited(const std::string& path, std::string_view ending) const;
};

/// The files of one tracking system, by its motion.tsv.
void check_bids_system(const std::string& motion_tsv, BidsCheck& check);
/// motion.tsv alone, against its channels: types, components and tracked points.
struct BidsRowsSummary {
  std::uint64_t rows = 0, latencies = 0;
  std::optional<double> first_latency_s, last_latency_s;
};
struct BidsChannel;
BidsRowsSummary check_bids_rows(const std::string& path, const std::vector<BidsChannel>& channels,
                                BidsCheck& check);

}  // namespace kinalign
