// SPDX-License-Identifier: Apache-2.0
// The index of a data set: an SQLite file that is only a cache. When it is opened, it is updated
// from dataset.toml and the takes' summaries (take_summary.h). A damaged index is made again. If it
// can't be written, it is made in memory.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/view/table.h"

#include <memory>
#include <string>
#include <vector>

namespace kinalign {

/// Reads the dataset.toml of a folder. Fails if the folder is no data set.
Result<Catalogue> load_catalogue(FileSystem& files, const std::string& folder);

/// The takes of a data set as tables that can be queried in SQL. All of its content comes from the
/// files, so an error of the index loses no data. Takes without a summary are not in it.
class DatasetIndex {
 public:
  /// Opens and updates the index. Unchanged folders are not read. `folder` does not end with '/'.
  static Result<DatasetIndex> open(FileSystem& files, const std::string& folder);
  DatasetIndex(DatasetIndex&&) noexcept;
  DatasetIndex& operator=(DatasetIndex&&) noexcept;
  DatasetIndex(const DatasetIndex&) = delete;
  DatasetIndex& operator=(const DatasetIndex&) = delete;
  ~DatasetIndex();

  const Catalogue& catalogue() const;
  /// A finding for each summary that can't be read.
  const Findings& findings() const;

  /// Runs one SELECT on the views `takes` and `streams`, with values for its '?'. Statements that
  /// write are refused. Errors contain SQLite's message.
  Result<Table> select(const std::string& sql, const std::vector<Cell>& values = {}) const;

  /// The number of takes that have a manifest or a file but no summary. No list contains them.
  Result<std::uint64_t> not_built() const;

  /// The columns of the view `takes`, in order.
  static const std::vector<TableColumn>& columns();

 private:
  struct State;
  explicit DatasetIndex(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
