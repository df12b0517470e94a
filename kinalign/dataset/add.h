// SPDX-License-Identifier: Apache-2.0
// Recordings, manifests and takes are added to a data set. Raw files stay where they are, or are
// copied below sourcedata/.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"

#include <string>

namespace kinalign {

struct AddRequest {
  std::string path;             // a recording, a recording.toml or a take
  std::string subject, action;  // empty: as the file says
  bool copy = false;            // raw files, to sourcedata/sub-03/NAME/
};

struct Added {
  TakeName name;
  bool was_there = false;  // the same manifest, or the same take, was added before
};

/// Gives the take the next free run of its subject and action, and writes its manifest, or copies
/// the take. Fails where the file is of another kind, and where dataset.toml has no such subject or
/// action. Paths of files below the data set's folder become relative, others absolute.
Result<Added> add_take(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                       const AddRequest& request, const Progress& progress);

}  // namespace kinalign
