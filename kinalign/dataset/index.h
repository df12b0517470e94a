// SPDX-License-Identifier: Apache-2.0
// The index of a data set: an SQLite file that is only a cache. It is brought up to date when it is
// opened, from dataset.toml and from the summaries beside the takes (take_summary.h); where it is
// damaged, or can't be written, it is made anew, at need in memory.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/view/table.h"

#include <memory>
#include <string>
#include <vector>

namespace kinalign {

/// Reads dataset.toml of a folder; fails where it is none of a data set.
Result<Catalogue> load_catalogue(FileSystem& files, const std::string& folder);

class DatasetIndex {
 public:
  /// Folders of which nothing has changed are not read. `folder` ends without '/'.
  static Result<DatasetIndex> open(FileSystem& files, const std::string& folder);
  DatasetIndex(DatasetIndex&&) noexcept;
  DatasetIndex& operator=(DatasetIndex&&) noexcept;
  DatasetIndex(const DatasetIndex&) = delete;
  DatasetIndex& operator=(const DatasetIndex&) = delete;
  ~DatasetIndex();

  const Catalogue& catalogue() const;
  /// Summaries that can't be read.
  const Findings& findings() const;

  /// Runs one SELECT with values for its '?', of the views `takes` and `streams`. Nothing but
  /// reading is allowed; fails with SQLite's words.
  Result<Table> select(const std::string& sql, const std::vector<Cell>& values = {}) const;

  /// How many takes have a manifest or a take, but no summary yet: they are in no list.
  Result<std::uint64_t> not_built() const;

  /// The columns of `takes`, in their order.
  static const std::vector<TableColumn>& columns();

 private:
  struct State;
  explicit DatasetIndex(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
