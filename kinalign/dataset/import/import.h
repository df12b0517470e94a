// SPDX-License-Identifier: Apache-2.0
// A published corpus into a data set: dataset.toml gets its people and actions, each of its takes a
// manifest. Taking it in again adds nothing twice.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/add.h"
#include "kinalign/dataset/import/corpus.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

struct ImportRequest {
  std::vector<std::string> sources;  // folders, files and archives
  std::string from;                  // a kind of corpus; empty: by the files
  std::string subject, action;       // of files that say none
  double metres_per_unit = 0.0;      // of the files; 0: their format's own
  std::string up;                    // their up axis, "y" or "z"; empty: their format's own
  bool copy = false;                 // raw files that lie outside of the data set
  std::size_t jobs = 1;              // threads to use
};

struct Imported {
  std::string kind;
  std::uint64_t takes = 0, were_there = 0;  // of the corpus; of these those that were there before
  std::uint64_t subjects = 0, actions = 0;  // of these takes
  bool is_new = false;                      // the folder was no data set before
  std::vector<LeftOut> left_out;
  /// Words of the corpus that could be no ids, and the ids that stand for them.
  std::vector<std::pair<std::string, std::string>> subject_ids, action_ids;
};

/// Called after each take with how many are done, of how many.
using ImportStep = std::function<void(std::uint64_t done, std::uint64_t takes)>;

/// Fails where the corpus is not known or has no take, where a unit or an up axis is given for one
/// whose files state theirs, and where a file can't be read or written;
/// takes that were added before then stay.
Result<Imported> import_corpus(FileSystem& files, const std::string& folder,
                               const ImportRequest& request, const Progress& progress,
                               const ImportStep& step);

}  // namespace kinalign
