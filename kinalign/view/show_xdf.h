// SPDX-License-Identifier: Apache-2.0
// An XDF file as an MCAP file of JSON: a channel for each stream, whole numbers and doubles as they
// are. docs/formats/xdf.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/view/shown_file.h"

#include <string>

namespace kinalign {

struct ShownXdf {
  Shown shown;
  Findings findings;
};

/// Log times are the recorder's clock, on which XDF knows no date: stamps with the stream's clock
/// offsets (formats/xdf/xdf.h). Publish times are the stamps as they stand. Each stream's header is
/// an attachment. Messages stand in the order of the file.
Result<ShownXdf> show_xdf(FileSystem& files, const std::string& from, const std::string& out,
                          Overwrite overwrite, const Progress& progress = {});

}  // namespace kinalign
