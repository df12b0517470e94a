// SPDX-License-Identifier: Apache-2.0
// Shared by the verbs of a data set: the folder, the index, findings and splits.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/dataset/changes/split_files.h"
#include "kinalign/dataset/index.h"
#include "kinalign/dataset/split.h"

#include <nlohmann/json_fwd.hpp>

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

/// The first lines, and the last one if there are more: "{}" in it is the number of the others.
std::string first_lines(const std::vector<std::string>& lines, std::size_t most,
                        const std::string& last);

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

/// The lines about splits that name takes which do not exist any more; empty without such splits.
/// A verb that changes names prints them, since it never edits a split: it may be part of published
/// results.
std::string splits_text(const std::vector<SplitFile>& splits);
nlohmann::ordered_json splits_json(const std::vector<SplitFile>& splits);

}  // namespace kinalign
