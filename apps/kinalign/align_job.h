// SPDX-License-Identifier: Apache-2.0
// Alignment from files to a file: what `align` does and `rebuild` does again.
#pragma once

#include "apps/kinalign/verb.h"

#include "kinalign/core/progress.h"
#include "kinalign/take/recording.h"
#include "kinalign/take/take.h"

#include <string>

namespace kinalign {

/// Aligns a recording and writes the take; `out` empty: writes nothing.
Result<AlignmentReport> align_to_file(FileSystem& files, const Recording& recording,
                                      const Manifest& manifest, const std::string& out,
                                      Overwrite overwrite, const Progress& progress);

}  // namespace kinalign
