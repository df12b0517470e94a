// SPDX-License-Identifier: Apache-2.0
// Finds files of splits that name renamed or removed takes.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/split.h"
#include "kinalign/dataset/take_name.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace kinalign {

/// All splits in the folder and in splits/, by their paths below the folder. Other files are
/// ignored.
std::map<std::string, Split> splits_in(FileSystem& files, const std::string& folder);

/// A file of a split that names renamed or removed takes. It is reported and not changed, because a
/// split is a decision of the user.
struct SplitFile {
  std::string path;         // below the data set's folder
  std::uint64_t takes = 0;  // number of the given takes that the split names
};

/// The splits of splits_in() that name any of `takes`.
std::vector<SplitFile> splits_naming(FileSystem& files, const std::string& folder,
                                     const std::set<TakeName>& takes);

}  // namespace kinalign
