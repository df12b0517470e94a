// SPDX-License-Identifier: Apache-2.0
// The first pass over a stream's file. It hashes and surveys the file and does not store rows.
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

/// A surveyed stream, with the data that its caller needs to name the files and to set the clock.
struct SurveyedFile {
  RecordedStream stream;           // its files have names only
  std::vector<std::string> paths;  // paths of these files; the stream's own file is first
  std::optional<TimeModel> clock;  // set if the file states the clock of its stamps
  std::shared_ptr<RecordingSource> recording;  // the recording that contains the stream, if any
};

/// Surveys a file. Paths in `file` and `options` must be relative to the current folder. `files`
/// must outlive the stream. Later passes fail if the file has changed.
Result<SurveyedFile> survey_file(FileSystem& files, const StreamOptions& options,
                                 const StreamFile& file, const Progress& progress);

/// Surveys one device of a recording that was already read.
Result<SurveyedFile> survey_device(FileSystem& files, const StreamOptions& options,
                                   const StreamFile& file,
                                   const std::shared_ptr<RecordingSource>& recording,
                                   const Progress& progress);

}  // namespace kinalign
