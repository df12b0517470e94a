// SPDX-License-Identifier: Apache-2.0
// Repairs a recording that was truncated, or split over several files by a bad disk. The result is
// one complete file with an index: every readable message once, and all metadata and attachments.
// It is read again to prove that it contains as many messages, with the same numbers, times and
// payloads.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/recovered.h"

#include <string>
#include <vector>

namespace kinalign {

/// `paths`: files of the recording in any order. Sibling files of the same recording are added. If
/// the disk cannot read a page (EIO), the other pages are used, unless it is a file's first page.
/// Fails if the files do not belong to one recording, if `out` is one of them, or if nothing can be
/// read. The new file gets the name `out` only after it was written, synced and read again without
/// a difference.
Result<Recovered> recover_recording(FileSystem& files, const std::vector<std::string>& paths,
                                    const std::string& out, Overwrite overwrite,
                                    const Progress& progress = {});

}  // namespace kinalign
