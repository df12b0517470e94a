// SPDX-License-Identifier: Apache-2.0
// Files into a Recording: each is read once to hash it and to learn its stamps, and can then be
// read again, block by block, as often as alignment needs.
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

struct OpenWith {
  Progress progress{};  // never called on two threads at once
  /// Threads to use: files are read side by side, which changes nothing but the time.
  std::size_t jobs = 1;
  /// A recording that was opened already, if the streams are read from it.
  std::shared_ptr<RecordingSource> recording{};
};

/// The recorded streams of the given ones: one each, or one for each file of nodes. Paths are taken
/// as they stand. `files` must outlive the streams. A recording is read once, however many streams
/// it has. Of several failures the error is that of the first file, in their order.
Result<Recording> open_streams(FileSystem& files, const std::vector<StreamOptions>& streams,
                               const OpenWith& with = {});

/// All streams of a manifest; relative paths are relative to `folder` ("" or ending in '/').
Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const OpenWith& with = {});

/// The same of what can be read, and of each stream or node that can't a warning why.
struct OpenedInPart {
  Recording recording;
  Findings left_out;
};
Result<OpenedInPart> open_what_can_be(FileSystem& files, const Manifest& manifest,
                                      const std::string& folder, const OpenWith& with = {});

/// Reads the streams to their ends whose late findings have not come yet, side by side.
Result<void> read_through(const Recording& recording, const Progress& progress = {});

}  // namespace kinalign
