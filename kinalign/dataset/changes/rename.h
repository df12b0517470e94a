// SPDX-License-Identifier: Apache-2.0
// Takes, people and actions of a data set get other names.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

enum class RenameKind { take, subject, action };

/// The steps of one rename, known before anything is changed.
struct RenamePlan {
  RenameKind kind = RenameKind::take;
  std::string from, to;  // as dataset.toml and file names have them: "03", "S2A03", a take's name
  std::vector<std::pair<TakeName, TakeName>> takes;
  bool was_begun = false;  // by a run that was stopped
};

/// `from`: a take, "sub-03" or an action's id; `to`: another one of the same kind. Fails where the
/// new name is taken, and where a take could not be made again: subject and action stand in a
/// take's own bytes, so that it needs its manifest and its raw files. A rename that was stopped is
/// gone on with; any other has to wait for it.
Result<RenamePlan> plan_rename(FileSystem& files, const std::string& folder,
                               const Catalogue& catalogue, const std::string& from,
                               const std::string& to);

struct Renamed {
  std::uint64_t moved = 0;     // takes with the bytes that they had
  std::uint64_t to_build = 0;  // takes that were dropped, to be made again under the new name
};

/// Moves manifests, takes, summaries and raw files below sourcedata/, and edits dataset.toml. A
/// file in the data set's folder says what is going on, so that a run that was killed at any moment
/// can be gone on with by the same plan.
Result<Renamed> rename_takes(FileSystem& files, const std::string& folder, const RenamePlan& plan);

}  // namespace kinalign
