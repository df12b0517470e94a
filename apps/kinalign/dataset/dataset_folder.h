// SPDX-License-Identifier: Apache-2.0
// Functions that the verbs of data sets share: for the folder, the index, findings and splits.
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

/// The description of the first word of each verb: the data set's folder. `folder` gets exactly one
/// word. It must live as long as the returned description.
Positional folder_word(std::vector<std::string>& folder);
/// The folder's path without a '/' at its end. An empty path gives ".".
std::string folder_of(const std::vector<std::string>& words);

/// The flags --where and --split, which choose takes. Several verbs have them, always with the same
/// meaning. An empty text means that the flag was not given.
Field where_field(std::string& where);
Field split_field(std::string& split);

/// The first `most` lines. If there are more, the text `last` follows, with the number of further
/// lines in place of "{}".
std::string first_lines(const std::vector<std::string>& lines, std::size_t most,
                        const std::string& last);

/// Opens the index of a data set. Every verb that reads takes calls it first. Summaries that have
/// changed are read again; all others come from the index. Problems of the files are printed on
/// stderr.
Result<DatasetIndex> open_index(const std::string& folder, Call& call);

/// If some takes have no summary yet, because they were not built, prints a line with their number.
Result<void> print_not_built(const DatasetIndex& index, const std::string& folder, Call& call);

/// Prints the first findings and the number of the others. Returns true if at least one finding is
/// an error. The verb's exit code depends on it.
bool print_findings(const Findings& findings, Call& call);

/// The takes that have been built, sorted by name. `where`: a condition in SQL; empty: all takes.
/// print_not_built() reports the takes that have not been built.
Result<std::vector<SplitTake>> built_takes(FileSystem& files, const std::string& folder,
                                           const DatasetIndex& index, const std::string& where);

/// The lines about splits that name takes which no longer exist. Empty without such splits. A verb
/// that changes names prints them. It never edits a split, because the split may be part of
/// published results.
std::string splits_text(const std::vector<SplitFile>& splits);
nlohmann::ordered_json splits_json(const std::vector<SplitFile>& splits);

}  // namespace kinalign
