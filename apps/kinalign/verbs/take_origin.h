// SPDX-License-Identifier: Apache-2.0
// Reads from a take how it was made, and finds out whether its input files have changed.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <string>
#include <vector>

namespace kinalign {

/// The part of a take that states how the take was made. `rebuild` aligns the inputs again with it.
/// `report` reads the raw samples with it.
struct Origin {
  std::string software;
  Manifest parameters;
  std::vector<InputFacts> files;  // names and hashes; sizes are 0
};

/// Reads how a take was made. A child process reads the file.
Result<Origin> origin_of(FileSystem& files, const std::string& path);

/// The names of inputs whose bytes have changed since the take was made.
std::vector<std::string> changed_inputs(const Origin& origin, const Recording& recording);

}  // namespace kinalign
