// SPDX-License-Identifier: Apache-2.0
// The first pass over a stream's file: hashed and surveyed, rows are thrown away.
#pragma once

#include "kinalign/core/file_version.h"
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

struct SurveyJob {
  FileSystem* files = nullptr;
  const StreamOptions* options = nullptr;  // a layout's path as it can be opened
  const Progress* progress = nullptr;
  std::optional<FileVersion> version;  // of the file, before it was opened
};

struct SurveyedFile {
  RecordedStream stream;                       // its files by their names only
  std::vector<std::string> paths;              // where these files lie; the stream's own first
  std::optional<TimeModel> clock;              // where the file itself says what its stamps are
  std::shared_ptr<RecordingSource> recording;  // that it is a stream of, if any
};

/// `named.path` as it can be opened. Each later pass over the stream fails where the file changed.
Result<SurveyedFile> survey_file(const SurveyJob& job, const StreamFile& named);

/// The same of one device of a recording, which has been read already.
Result<SurveyedFile> survey_device(const SurveyJob& job, const StreamFile& named,
                                   const std::shared_ptr<RecordingSource>& recording);

}  // namespace kinalign
