// SPDX-License-Identifier: Apache-2.0
// Writes the streams of a recording or of a file as an MCAP file of JSON, which Foxglove and
// Lichtblick can display. Every sample has its time in UTC; skeletons are also written as frame
// transforms. The layout is in docs/formats/shown.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/take/recording.h"
#include "kinalign/view/shown_file.h"

#include <string>

namespace kinalign {

/// The output file, and the recording whose own messages are copied.
struct ShowFiles {
  /// The recording whose JSON channels (marks, counts, the host's clocks) are copied; nullptr:
  /// none.
  const RecordingSource* recording = nullptr;
  std::string out;
  Overwrite overwrite = Overwrite::no;
};

/// Writes the file. Messages are in the order of their times. Omitted messages are reported as a
/// finding. `recording` is read once, all streams in parallel.
Result<Findings> show_recording(FileSystem& files, const Recording& recording,
                                const ShowFiles& paths, const Progress& progress = {});

}  // namespace kinalign
