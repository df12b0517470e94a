// SPDX-License-Identifier: Apache-2.0
// Renames takes, people and actions of a data set.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// The kind of thing that is renamed. The rename of a subject or an action renames all of its
/// takes.
enum class RenameKind { take, subject, action };

/// The steps of one rename, planned before anything is changed.
struct RenamePlan {
  RenameKind kind = RenameKind::take;
  std::string from, to;  // ids or a take's name: "03", "S2A03"
  std::vector<std::pair<TakeName, TakeName>> takes;
  bool was_begun = false;  // true: a run that was stopped has begun this rename
};

/// `from`: a take, "sub-03" or an action's id; `to`: another name of the same kind. Fails if the
/// new name is taken. Also fails if the manifest or raw files of a take are missing: its bytes
/// contain subject and action, so it must be made again. A stopped rename is continued; any other
/// rename must wait for it.
Result<RenamePlan> plan_rename(FileSystem& files, const std::string& folder,
                               const Catalogue& catalogue, const std::string& from,
                               const std::string& to);

/// The outcome for the user: how many takes only moved, and how many have to be built again.
struct Renamed {
  std::uint64_t moved = 0;     // takes whose bytes are unchanged
  std::uint64_t to_build = 0;  // takes that were dropped, to be made again under the new name
};

/// Moves manifests, takes, summaries and raw files below sourcedata/, and edits dataset.toml. The
/// plan is stored in a journal in the data set's folder. If a run is stopped at any moment, the
/// same plan can continue it.
Result<Renamed> rename_takes(FileSystem& files, const std::string& folder, const RenamePlan& plan);

}  // namespace kinalign
