// SPDX-License-Identifier: Apache-2.0
// Alignment from files to a file: what `align` does and `rebuild` does again.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/take/recording.h"
#include "kinalign/take/take.h"

#include <string>

namespace kinalign {

/// Where a take is to go; without a path nowhere.
struct TakeTarget {
  std::string path;
  Overwrite overwrite = Overwrite::no;
};

/// Aligns a recording and writes the take.
Result<AlignmentReport> align_to_file(const Call& call, const Recording& recording,
                                      const Manifest& manifest, const TakeTarget& target);

}  // namespace kinalign
