// SPDX-License-Identifier: Apache-2.0
// A recording's streams, or a file's, as an MCAP file of JSON that Foxglove and Lichtblick show:
// every sample at its time on UTC, skeletons as frame transforms too. docs/formats/shown.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/parts.h"
#include "kinalign/take/recording.h"
#include "kinalign/view/shown_file.h"

#include <string>

namespace kinalign {

struct ShowFiles {
  RecordingParts
      from;  // a recording's files: their JSON channels (marks, counts, clocks) are copied
  std::string out;
  Overwrite overwrite = Overwrite::no;
};

/// Messages stand in the order of their times, but for those copied, which come last.
Result<Shown> show_recording(FileSystem& files, const Recording& recording, const ShowFiles& paths,
                             const Progress& progress = {});

}  // namespace kinalign
