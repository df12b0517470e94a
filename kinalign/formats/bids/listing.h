// SPDX-License-Identifier: Apache-2.0
// Lists a folder for the checker of BIDS.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bids/check.h"

#include <string>

namespace kinalign {

/// All files below `folder`; links are not followed. `files` must outlive the result. Fails if the
/// folder can't be read.
/// Paths are read when the checker asks for them, one at a time.
Result<BidsListing> list_bids_folder(FileSystem& files, const std::string& folder);

}  // namespace kinalign
