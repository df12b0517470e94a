// SPDX-License-Identifier: Apache-2.0
// A torn recording, or one that a bad disk split over several files, made into one whole file:
// every message that can be read, once, all metadata and attachments, with an index. What was
// written is read again to prove it: as many messages, and the same numbers, times and payloads.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/recovered.h"

#include <string>
#include <vector>

namespace kinalign {

/// `paths`: files of the recording in any order, with those of its files that lie beside them.
/// Where a disk can't give a page (EIO), but a file's first, the others are read. Fails where files
/// are not all of one recording, `out` is one of them, or nothing can be read. Nothing
/// stands at `out` before all is written and synced. It is read again before it gets its name: what
/// is not what was written never does.
Result<Recovered> recover_recording(FileSystem& files, const std::vector<std::string>& paths,
                                    const std::string& out, Overwrite overwrite,
                                    const Progress& progress = {});

}  // namespace kinalign
