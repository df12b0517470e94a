// SPDX-License-Identifier: Apache-2.0
// Shared by the verbs of a data set: the folder, the index, and findings.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/dataset/index.h"
#include "kinalign/dataset/split.h"

#include <string>
#include <vector>

namespace kinalign {

/// The first word of every verb: the data set's folder.
/// The parser guarantees one word. `folder` must outlive the Positional.
Positional folder_word(std::vector<std::string>& folder);
/// The folder's path without a '/' at its end; "." if it is empty.
std::string folder_of(const std::vector<std::string>& words);

/// The flags of verbs that work on chosen takes: --where and --split.
/// Both names mean the same for every verb, so they are described once. An empty text means that
/// the flag was not given.
Field where_field(std::string& where);
Field split_field(std::string& split);

/// Opens the index. Problems of its files are printed on stderr.
/// Every verb that reads takes calls it first. Summaries that changed since the last call are read
/// again, all others come from the index.
Result<DatasetIndex> open_index(const std::string& folder, Call& call);

/// Prints a line if some takes have no summary yet.
Result<void> print_not_built(const DatasetIndex& index, const std::string& folder, Call& call);

/// Prints the first findings and the number of the others. True if one is an error.
/// The exit code of a verb follows from the result. Notes and warnings give false.
bool print_findings(const Findings& findings, Call& call);

/// The built takes, sorted by name. `where`: a condition of SQL; empty: all takes.
/// Takes without a summary are not among them; print_not_built() tells the user how many there are.
Result<std::vector<SplitTake>> built_takes(FileSystem& files, const std::string& folder,
                                           const DatasetIndex& index, const std::string& where);

}  // namespace kinalign
