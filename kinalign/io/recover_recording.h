// SPDX-License-Identifier: Apache-2.0
// A torn recording, or one that a bad disk split over several files, made into one whole file:
// every message that can be read, once, all metadata and attachments, with an index. What was
// written is read again to prove it: as many messages, and the same numbers, times and payloads.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/io/recording_survey.h"

#include <string>
#include <vector>

namespace kinalign {

struct Recovered {
  std::uint64_t messages = 0;
  /// Of these no checksum covers: from a torn end, from chunks without one, or outside of chunks.
  std::uint64_t unchecked = 0;
  std::uint64_t twice =
      0;  // further copies: of those that stood in several files the best was taken
  std::uint64_t nameless = 0;  // left out: the definition of their channel is lost
  std::uint64_t skipped = 0;   // bytes of the old files in which nothing could be read
  /// Of which it is known that they were there: by their numbers or, of a single file, by its own
  /// count.
  std::uint64_t missing = 0;
  RecordingSurvey proof;  // of the new file
  Findings findings;      // of the old ones, and of the new one's order
};

/// `paths`: files of the recording in any order, with those of its files that lie beside them.
/// Where a disk can't give a page (EIO), but a file's first, the others are read. Fails where files
/// are not all of one recording, `out` is one of them, or nothing can be read. Nothing
/// stands at `out` before all is written and synced. It is read again before it gets its name: what
/// is not what was written never does.
Result<Recovered> recover_recording(FileSystem& files, const std::vector<std::string>& paths,
                                    const std::string& out, Overwrite overwrite,
                                    const Progress& progress = {});

}  // namespace kinalign
