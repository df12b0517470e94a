// SPDX-License-Identifier: Apache-2.0
// The parameters and inputs that a take was made from, and whether the inputs have changed.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <string>
#include <vector>

namespace kinalign {

/// The part of a take's header that tells how it was made. `rebuild` aligns again by it; `report`
/// reads the raw samples by it.
struct Origin {
  std::string software;
  Manifest parameters;
  std::vector<InputFacts> files;  // names and hashes only, no sizes
};

/// Reads the take's origin in a child process.
Result<Origin> origin_of(FileSystem& files, const std::string& path);

/// The names of inputs whose bytes differ from those that the take was made from.
std::vector<std::string> changed_inputs(const Origin& origin, const Recording& recording);

}  // namespace kinalign
