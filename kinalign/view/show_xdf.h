// SPDX-License-Identifier: Apache-2.0
// Writes an XDF file as an MCAP file of JSON: a channel for each stream; whole numbers and doubles
// keep their values. docs/formats/xdf.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/view/shown_file.h"

#include <string>

namespace kinalign {

/// Log times are on the recorder's clock, which has no date in XDF: stamps with the stream's clock
/// offsets (formats/xdf/xdf.h). Publish times are the stamps in the file. Each stream's header is
/// an attachment. Messages keep the order of the file. Returns the faults of the old file.
Result<Findings> show_xdf(FileSystem& files, const std::string& from, const std::string& out,
                          Overwrite overwrite, const Progress& progress = {});

}  // namespace kinalign
