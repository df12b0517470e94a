// SPDX-License-Identifier: Apache-2.0
// Repairs a recording that was truncated, or split over several files by a bad disk. The result is
// one complete file with an index: every readable message once, and all metadata and attachments.
// It is read again to prove that it contains the same messages.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The figures of one recovery. They describe the old files; the new file was read again and is
/// complete.
struct Recovered {
  std::uint64_t messages = 0;
  std::size_t channels = 0;  // with messages
  /// Messages without a checksum: from a truncated end, from chunks without one, or outside of
  /// chunks.
  std::uint64_t unchecked = 0;
  std::uint64_t twice = 0;     // further copies of messages in several files
  std::uint64_t nameless = 0;  // left out, because the definition of their channel is lost
  std::uint64_t skipped = 0;   // bytes of the old files that could not be read
  /// Messages known to be missing, by their numbers or, for a single file, by its own count.
  std::uint64_t missing = 0;
  Findings findings;  // on the old files
};

/// `paths`: files of the recording in any order. The other parts in their folders are added. Fails
/// if the files do not belong to one recording, if `out` is one of them, if a disk cannot read a
/// page, or if nothing can be read. The new file gets the name `out` only after it was written,
/// synced and read again without a difference.
Result<Recovered> recover_recording(FileSystem& files, const std::vector<std::string>& paths,
                                    const std::string& out, Overwrite overwrite,
                                    const Progress& progress = {});

}  // namespace kinalign
