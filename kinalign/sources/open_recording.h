// SPDX-License-Identifier: Apache-2.0
// Opens files as a Recording. Each file is read once to hash it and to survey its stamps; alignment
// can then read it again in blocks, as often as needed.
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

/// The way in which files are opened. None of it changes the result.
struct OpenWith {
  Progress progress{};  // never called on two threads at once
  /// Threads to use. Files are read in parallel, which changes only the time needed.
  std::size_t jobs = 1;
  /// A recording that is open already, if the streams are in it.
  std::shared_ptr<RecordingSource> recording{};
};

/// Opens streams: one for each, or one for each file of nodes. Paths are relative to the current
/// folder. `files` must outlive the streams. A recording is read once, however many streams it has.
/// If several files fail, the first failure in the order of the files is returned.
Result<Recording> open_streams(FileSystem& files, const std::vector<StreamOptions>& streams,
                               const OpenWith& with = {});

/// Opens all streams of a manifest; relative paths are relative to `folder` ("" or ending in '/').
Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const OpenWith& with = {});

/// The streams that could be opened, and a warning with the reason for each that could not.
/// Programs that show or convert a recording use what there is.
struct OpenedInPart {
  Recording recording;
  Findings left_out;
};
Result<OpenedInPart> open_what_can_be(FileSystem& files, const Manifest& manifest,
                                      const std::string& folder, const OpenWith& with = {});

/// Reads those streams in parallel to their ends whose late findings are not known yet.
Result<void> read_through(const Recording& recording, const Progress& progress = {});

}  // namespace kinalign
