// SPDX-License-Identifier: Apache-2.0
// The first pass over a stream's file: hashes and surveys it; rows are dropped.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A stream that was surveyed, and what its caller needs to name its files and to set its clock.
struct SurveyedFile {
  RecordedStream stream;           // its files have only their names
  std::vector<std::string> paths;  // paths of these files; the stream's own first
  std::optional<TimeModel> clock;  // set if the file itself states the clock of its stamps
  std::shared_ptr<RecordingSource> recording;  // the recording with the stream, if any
};

/// Surveys a file. The paths in `file` and `options` can be opened from here; `files` must outlive
/// the stream. Later passes fail if the file has changed.
Result<SurveyedFile> survey_file(FileSystem& files, const StreamOptions& options,
                                 const StreamFile& file, const Progress& progress);

/// The same for one device of a recording, which has been read already.
Result<SurveyedFile> survey_device(FileSystem& files, const StreamOptions& options,
                                   const StreamFile& file,
                                   const std::shared_ptr<RecordingSource>& recording,
                                   const Progress& progress);

}  // namespace kinalign
