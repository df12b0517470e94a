// SPDX-License-Identifier: Apache-2.0
// A folder as the checker of BIDS sees it.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bids/check.h"

#include <string>

namespace kinalign {

/// All files below `folder`, which `files` must outlive; links are not followed. Fails where the
/// folder can't be read.
Result<BidsListing> list_bids_folder(FileSystem& files, const std::string& folder);

}  // namespace kinalign
