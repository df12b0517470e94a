// SPDX-License-Identifier: Apache-2.0
// Files into a Recording: each is read once to hash it and to learn its stamps, and can then be
// read again, block by block, as often as alignment needs.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <string>
#include <vector>

namespace kinalign {

/// The recorded streams of the given ones: one each, or one for each file of nodes. Paths are taken
/// as they stand. `files` must outlive the streams. Files are read on up to `jobs` threads, which
/// changes nothing but the time; the first that fails, in their order, is the error. `progress` is
/// never called on two threads at once.
Result<std::vector<RecordedStream>> open_streams(FileSystem& files,
                                                 const std::vector<StreamOptions>& streams,
                                                 const Progress& progress = {},
                                                 std::size_t jobs = 1);

/// All streams of a manifest; relative paths are relative to `folder` ("" or ending in '/').
Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const Progress& progress = {},
                                 std::size_t jobs = 1);

/// The same of what can be read, and of each stream or node that can't a warning why.
struct OpenedInPart {
  Recording recording;
  Findings left_out;
};
Result<OpenedInPart> open_what_can_be(FileSystem& files, const Manifest& manifest,
                                      const std::string& folder, const Progress& progress = {},
                                      std::size_t jobs = 1);

}  // namespace kinalign
