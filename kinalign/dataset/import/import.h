// SPDX-License-Identifier: Apache-2.0
// Imports a published corpus into a data set: its people and actions are added to dataset.toml, and
// each of its takes gets a manifest. A second import of the same corpus adds nothing.
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

/// The choices of the user. Subject and action are used only for files that state none.
struct ImportRequest {
  std::vector<std::string> sources;  // folders, files and archives
  std::string from;                  // a kind of corpus; empty: recognised by the files
  std::string subject, action;       // for files that state none
  double metres_per_unit = 0.0;      // the files' unit; 0: the usual unit of the format
  std::string up;        // up axis of the files, "y" or "z"; empty: the usual axis of the format
  bool copy = false;     // copy raw files from outside the data set
  std::size_t jobs = 1;  // threads to use
};

/// The outcome for the user: what was found, what is new, and what was left out.
struct Imported {
  std::string kind;
  std::uint64_t takes = 0, were_there = 0;  // takes of the corpus, and those that existed before
  std::uint64_t subjects = 0, actions = 0;  // number of people and of actions in these takes
  bool is_new = false;                      // the folder was no data set before
  std::vector<LeftOut> left_out;
  /// Words of the corpus that can't be ids, with the ids made from them.
  std::vector<std::pair<std::string, std::string>> subject_ids, action_ids;
};

/// Called after each take with the numbers of finished takes and of all takes.
using ImportStep = std::function<void(std::uint64_t done, std::uint64_t takes)>;

/// Imports a corpus. Fails if the corpus is unknown or has no take, or if a file can't be read or
/// written. Also fails if a unit or an up axis is given for files that state their own. Takes that
/// were added before a failure stay.
Result<Imported> import_corpus(FileSystem& files, const std::string& folder,
                               const ImportRequest& request, const Progress& progress,
                               const ImportStep& step);

}  // namespace kinalign
