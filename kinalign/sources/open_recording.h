// SPDX-License-Identifier: Apache-2.0
// Opens files as a Recording. Each file is read once to hash it and to survey its stamps. Alignment
// can then read the file again in blocks, as often as needed.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <memory>
#include <string>
#include <vector>

namespace kinalign {

/// Options for opening files. They do not change the result.
struct OpenWith {
  Progress progress{};  // never called on two threads at once
  /// Number of threads. With several threads, files are read in parallel.
  std::size_t jobs = 1;
  /// The recording that contains the streams, if the caller has already opened it.
  std::shared_ptr<RecordingSource> recording{};
};

/// Opens streams: one for each element, or one for each file of nodes. Paths are relative to the
/// current folder. `files` must outlive the streams. A recording is read once, even if several of
/// its streams are opened. If several files fail, the failure of the first file is returned.
Result<Recording> open_streams(FileSystem& files, const std::vector<StreamOptions>& streams,
                               const OpenWith& with = {});

/// Opens all streams of a manifest. Relative paths are relative to `folder` ("" or ending in '/').
Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const OpenWith& with = {});

/// The streams that could be opened, and for each other stream a warning with the reason. Programs
/// that show or convert a recording use the streams that are available.
struct OpenedInPart {
  Recording recording;
  Findings left_out;
};
Result<OpenedInPart> open_what_can_be(FileSystem& files, const Manifest& manifest,
                                      const std::string& folder, const OpenWith& with = {});

/// Reads streams to their ends in parallel, if their late findings are not known yet.
Result<void> read_through(const Recording& recording, const Progress& progress = {});

}  // namespace kinalign
