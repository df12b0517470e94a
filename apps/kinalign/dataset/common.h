// SPDX-License-Identifier: Apache-2.0
// What the verbs of a data set share.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/dataset/index.h"
#include "kinalign/view/table.h"

#include <string>
#include <vector>

namespace kinalign {

/// The first word of every verb: the data set's folder.
Positional folder_word(std::vector<std::string>& folder);
/// Without a '/' at its end; "." where that is nothing.
std::string folder_of(const std::vector<std::string>& words);

/// Opens the index and tells what is wrong with its files on stderr.
Result<DatasetIndex> open_index(const std::string& folder, Call& call);

/// --format: how a table is printed; with --json it is JSON whatever the flag says.
Field format_field(std::string& format);
/// Prints a table as `format` says, or as the member `name` of a JSON object.
void print_table(const Table& table, const std::string& format, const std::string& name,
                 Call& call);

}  // namespace kinalign
