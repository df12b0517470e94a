// SPDX-License-Identifier: Apache-2.0
// Checks a BIDS-Motion data set. Finds some faults that the official validator does not find.
// Rules: docs/formats/bids.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/file_sink.h"

#include <functional>
#include <set>
#include <string>

namespace kinalign {

/// The checker's view of a data set: the paths of its files and their content.
/// The checker sees a data set through these functions only, so tests need no disk.
struct BidsListing {
  /// Paths of the files, relative to the data set's folder, with "/" as separator.
  std::set<std::string> paths;
  /// Passes the file's bytes to `use` in pieces of any size. Fails if the file can't be read.
  std::function<Result<void>(const std::string& path, const FileSink& use)> read;

  bool has(const std::string& path) const { return paths.contains(path); }
};

/// All files below `folder`; links are not followed. `files` must outlive the result. Fails if the
/// folder can't be read.
/// Files are read when the checker asks for them, one at a time.
Result<BidsListing> list_bids_folder(FileSystem& files, const std::string& folder);

/// Reads every motion file, and the tables and JSON files about them. Other data types are skipped.
/// Findings name files by their paths in the listing. Errors break the BIDS standard; warnings and
/// notes do not. Memory holds tables of at most 16 MiB each and one line of a motion.tsv.
/// Every cell of a motion.tsv is looked at.
Findings check_bids(const BidsListing& listing);

}  // namespace kinalign
