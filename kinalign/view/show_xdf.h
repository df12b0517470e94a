// SPDX-License-Identifier: Apache-2.0
// Writes an XDF file as an MCAP file of JSON with a channel for each stream. Integers and doubles
// keep their values. The layout is in docs/formats/xdf.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/view/shown_file.h"

#include <string>

namespace kinalign {

/// Log times are stamps on the recorder's clock, corrected by the stream's clock offsets
/// (formats/xdf/xdf.h); an XDF file states no date. Publish times are the stamps in the file. Each
/// stream's header is an attachment. Messages keep the order of the file. Returns the faults of the
/// XDF file.
Result<Findings> show_xdf(FileSystem& files, const std::string& from, const std::string& out,
                          Overwrite overwrite, const Progress& progress = {});

}  // namespace kinalign
