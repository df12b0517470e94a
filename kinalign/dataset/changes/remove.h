// SPDX-License-Identifier: Apache-2.0
// Takes of a data set are removed, with or without the raw files that were copied with them.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/take_name.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

struct RemovalPlan {
  std::vector<TakeName> takes;
  std::vector<std::string> files;     // below the data set's folder, in the order of removal
  std::vector<std::string> folders;   // that are empty then, inner ones first
  std::vector<std::string> raw_left;  // below sourcedata/, files and folders: --raw takes them, too
  std::vector<std::string> raw_kept;  // raw files that stay: they were not copied or unpacked there
  std::vector<std::string> raw_shared;  // raw files that stay since another take is made of them
  std::vector<std::string> unknown;     // names of which nothing is there
  std::uint64_t bytes = 0;
};

/// `names`: takes, or "sub-03" for all takes of a person. With `with_raw` the files below
/// sourcedata/sub-03/NAME/ go, too, and the takes' inputs in folders that an import unpacked to, of
/// which no other take is made. Raw files elsewhere, and whatever a link leads to, stay. Fails
/// where nothing is there of any of the names, and, with `with_raw`, where another take is made of
/// files below sourcedata/sub-03/NAME/, and where a manifest or a folder of raw files can't be
/// read.
Result<RemovalPlan> plan_removal(FileSystem& files, const std::string& folder,
                                 const std::vector<std::string>& names, bool with_raw);

/// Removes what is still there of the plan. A run that was killed is gone on with by a new plan.
Result<void> remove_takes(FileSystem& files, const std::string& folder, const RemovalPlan& plan);

}  // namespace kinalign
