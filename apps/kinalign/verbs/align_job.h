// SPDX-License-Identifier: Apache-2.0
// Aligns a recording into a file, for `align` and `rebuild`.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/take/recording.h"
#include "kinalign/take/take.h"

#include <string>

namespace kinalign {

/// The file of a new take. If the path is empty, the take is computed and not written.
struct TakeTarget {
  std::string path;
  Overwrite overwrite = Overwrite::no;
};

/// Aligns a recording and writes the take. HDF5 only writes here, which is safe without a child
/// process. If the alignment fails, no file is created or replaced.
Result<AlignmentReport> align_to_file(const Call& call, const Recording& recording,
                                      const Manifest& manifest, const TakeTarget& target);

}  // namespace kinalign
