// SPDX-License-Identifier: Apache-2.0
// Repairs a recording that was truncated, or that a bad disk split over several files. The result
// is one complete file with an index. It contains every readable message once, and all metadata and
// attachments. The file is read again to prove that it contains the same messages.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The results of one recovery. Except `findings`, they are counts about the old files. The new
/// file was read again and is complete.
struct Recovered {
  std::uint64_t messages = 0;
  std::size_t channels = 0;  // channels with messages
  /// Messages without a checksum. They come from a truncated end, from chunks without a checksum,
  /// or from outside of chunks.
  std::uint64_t unchecked = 0;
  std::uint64_t twice = 0;     // further copies of messages, which were left out
  std::uint64_t nameless = 0;  // left out, because no definition of their channel exists
  std::uint64_t skipped = 0;   // bytes of the old files that could not be read
  /// The count of missing messages. It comes from their numbers or, for a single file, from the
  /// statistics in the file.
  std::uint64_t missing = 0;
  Findings findings;  // about the old files
};

/// Repairs a recording. `paths`: files of the recording in any order; the other parts in their
/// folders are added. Fails if the files do not belong to one recording, if `out` is one of them,
/// if a disk cannot read a page, or if nothing can be read. The new file gets the name `out` only
/// after it was written, synced and read again without a difference.
Result<Recovered> recover_recording(FileSystem& files, const std::vector<std::string>& paths,
                                    const std::string& out, Overwrite overwrite,
                                    const Progress& progress = {});

}  // namespace kinalign
