// SPDX-License-Identifier: Apache-2.0
// Alignment from files to a file, for `align` and `rebuild`.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/take/recording.h"
#include "kinalign/take/take.h"

#include <string>

namespace kinalign {

/// The file of a new take. Without a path the take is computed and not written.
struct TakeTarget {
  std::string path;
  Overwrite overwrite = Overwrite::no;
};

/// Aligns a recording and writes the take.
/// HDF5 is only written here, so no child process is needed. If alignment fails, no file is created
/// or replaced.
Result<AlignmentReport> align_to_file(const Call& call, const Recording& recording,
                                      const Manifest& manifest, const TakeTarget& target);

}  // namespace kinalign
