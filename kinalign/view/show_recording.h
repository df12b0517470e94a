// SPDX-License-Identifier: Apache-2.0
// Writes the streams of a recording or of a file as an MCAP file of JSON that Foxglove and
// Lichtblick show: every sample at its time on UTC, skeletons also as frame transforms.
// docs/formats/shown.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/take/recording.h"
#include "kinalign/view/shown_file.h"

#include <string>

namespace kinalign {

/// The output, and the file whose own messages go along.
struct ShowFiles {
  /// The recording whose JSON channels (marks, counts, the host's clocks) are copied; nullptr:
  /// none.
  const RecordingSource* recording = nullptr;
  std::string out;
  Overwrite overwrite = Overwrite::no;
};

/// Messages are written in the order of their times. Messages that were left out are a finding.
/// `recording` is read once, all streams side by side.
Result<Findings> show_recording(FileSystem& files, const Recording& recording,
                                const ShowFiles& paths, const Progress& progress = {});

}  // namespace kinalign
