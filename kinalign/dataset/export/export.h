// SPDX-License-Identifier: Apache-2.0
// Writes a data set's takes as files of other programs.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_summary.h"

#include <string>
#include <vector>

namespace kinalign {

/// A take to export, with its facts from the index.
struct ExportTake {
  TakeName name;
  TakeSummary summary;
  std::string part;  // the part of a split; names of WebDataset shards begin with it
};

/// Everything that the user wants of an export: from where, to where, how, and which takes.
struct ExportJob {
  std::string folder;    // the data set's
  std::string target;    // a new folder
  std::string format;    // a name in export_formats()
  bool release = false;  // dates are moved to the year 2000, names of raw files are hidden
  std::vector<ExportTake> takes;
};

/// A format as the user sees it in lists and messages.
struct ExportFormat {
  std::string name, title;
  std::string lost;  // content that the format can't store
};
std::vector<ExportFormat> export_formats();

/// A stream that the format can't store. This is not an error.
struct LeftOutStream {
  TakeName name;
  std::string why;
};

/// The outcome of an export that succeeded.
struct ExportMade {
  std::uint64_t files = 0;
  std::vector<LeftOutStream> left_out;
  Findings findings;  // streams that could not be written; for BIDS also the findings of our check
};

/// Writes into the folder `target` + ".part", which is renamed to `target` at the end. `target`
/// must not exist before. After a failure the unfinished folder is removed. Runs in a child
/// process, because HDF5 can crash on a hostile file.
Result<ExportMade> export_takes(FileSystem& files, const Catalogue& catalogue, const ExportJob& job,
                                const Progress& progress);

}  // namespace kinalign
