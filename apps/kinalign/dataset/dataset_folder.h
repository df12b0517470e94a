// SPDX-License-Identifier: Apache-2.0
// Every verb of a data set begins with its folder, and most open its index.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/dataset/index.h"
#include "kinalign/dataset/split.h"

#include <string>
#include <vector>

namespace kinalign {

/// The first word of every verb: the data set's folder.
Positional folder_word(std::vector<std::string>& folder);
/// The folder's path without a '/' at its end; "." where that is nothing.
std::string folder_of(const std::vector<std::string>& words);

/// Flags of verbs that take a choice of takes: --where and --split.
Field where_field(std::string& where);
Field split_field(std::string& split);

/// Opens the index and tells what is wrong with its files on stderr.
Result<DatasetIndex> open_index(const std::string& folder, Call& call);

/// A line, where some takes have no summary yet.
Result<void> say_not_built(const DatasetIndex& index, const std::string& folder, Call& call);

/// Prints the first ones, and how many more there are; whether one is an error.
bool print_findings(const Findings& findings, Call& call);

/// Takes that are built, by name; of those alone for which a condition of SQL holds, if any is
/// said.
Result<std::vector<SplitTake>> built_takes(FileSystem& files, const std::string& folder,
                                           const DatasetIndex& index, const std::string& where);

}  // namespace kinalign
