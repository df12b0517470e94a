// SPDX-License-Identifier: Apache-2.0
// Every verb of a data set begins with its folder, and most open its index.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/dataset/index.h"

#include <string>
#include <vector>

namespace kinalign {

/// The first word of every verb: the data set's folder.
Positional folder_word(std::vector<std::string>& folder);
/// The folder's path without a '/' at its end; "." where that is nothing.
std::string folder_of(const std::vector<std::string>& words);

/// Opens the index and tells what is wrong with its files on stderr.
Result<DatasetIndex> open_index(const std::string& folder, Call& call);

}  // namespace kinalign
