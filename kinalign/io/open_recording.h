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

/// The streams of one stream's files: one, or one for each file of nodes. Paths are taken as they
/// stand. `files` must outlive the streams.
Result<std::vector<RecordedStream>> open_stream(FileSystem& files, const StreamOptions& options,
                                                const Progress& progress = {});

/// All streams of a manifest; relative paths are relative to `folder` ("" or ending in '/').
Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const Progress& progress = {});

}  // namespace kinalign
