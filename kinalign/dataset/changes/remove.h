// SPDX-License-Identifier: Apache-2.0
// Removes takes of a data set, with or without the raw files that were copied with them.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/take_name.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The whole removal, planned before any file is touched, so that the user can be asked first. All
/// paths are below the data set's folder.
struct RemovalPlan {
  std::vector<TakeName> takes;
  std::vector<std::string> files;     // in the order of removal
  std::vector<std::string> folders;   // empty after the removal, inner ones first
  std::vector<std::string> raw_left;  // files and folders below sourcedata/ that --raw would remove
  std::vector<std::string> raw_kept;  // raw files that stay: they were not copied or unpacked there
  std::vector<std::string> raw_shared;  // raw files that stay: another take is made from them
  std::vector<std::string> unknown;     // names without any file
  std::uint64_t bytes = 0;
};

/// `names`: takes, or "sub-03" for all takes of a person. With `with_raw` the files below
/// sourcedata/sub-03/NAME/ are removed, too, and inputs in folders that an import unpacked, if no
/// other take is made from them. Raw files elsewhere, and targets of links, stay. Fails if none of
/// the names has a file. With `with_raw` it also fails if another take is made from files below
/// sourcedata/sub-03/NAME/, or if a manifest or a folder of raw files can't be read.
Result<RemovalPlan> plan_removal(FileSystem& files, const std::string& folder,
                                 const std::vector<std::string>& names, bool with_raw);

/// Removes those files of the plan that still exist. If a run was stopped, a new plan continues it.
Result<void> remove_takes(FileSystem& files, const std::string& folder, const RemovalPlan& plan);

}  // namespace kinalign
