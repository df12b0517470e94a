// SPDX-License-Identifier: Apache-2.0
// What is wrong with a BIDS-Motion data set, also what the official validator does not find. Rules:
// docs/formats/bids.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/file_sink.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace kinalign {

/// A data set as its checker sees it: which files there are, and what is in them.
struct BidsListing {
  std::set<std::string> paths;  // of files, below the data set's folder, "/" between
  /// Hands on the file's bytes in pieces of any size. Fails where the file can't be read.
  std::function<Result<void>(const std::string& path, const FileSink& use)> read;

  bool has(const std::string& path) const { return paths.contains(path); }
};

/// Reads every file of motion, and the tables and JSON files about them; other data types are
/// passed over. Findings name files by their paths in the listing. Errors break BIDS, warnings and
/// notes do not. Memory goes by the tables, of at most 16 MiB each, and by one line of a
/// motion.tsv.
Findings check_bids(const BidsListing& listing);

}  // namespace kinalign
