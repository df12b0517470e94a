// SPDX-License-Identifier: Apache-2.0
// Checks a BIDS-Motion data set, and finds some faults that the official validator does not find.
// Rules: docs/formats/bids.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/file_sink.h"

#include <functional>
#include <set>
#include <string>

namespace kinalign {

/// The files of a data set: their paths and their content. The checker only uses this structure, so
/// tests need no disk.
struct BidsListing {
  /// The paths of the files, relative to the data set's folder, with "/" as separator.
  std::set<std::string> paths;
  /// Passes the bytes of a file to `use` in pieces of any size. Fails if the file can't be read.
  std::function<Result<void>(const std::string& path, const FileSink& use)> read;

  bool has(const std::string& path) const { return paths.contains(path); }
};

/// Lists all files below `folder`; links are not followed. A file is read only when the checker
/// needs it. `files` must exist longer than the result. Fails if the folder can't be read.
Result<BidsListing> list_bids_folder(FileSystem& files, const std::string& folder);

/// Reads every cell of every motion.tsv, and the tables and JSON files that describe them. Other
/// data types are skipped. Findings name files by their paths in the listing. Errors violate the
/// BIDS standard; warnings and notes do not. Tables of at most 16 MiB each and one line of a
/// motion.tsv are in memory.
Findings check_bids(const BidsListing& listing);

}  // namespace kinalign
