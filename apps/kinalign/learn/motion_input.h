// SPDX-License-Identifier: Apache-2.0
// What denoise and pose open that is no take.
#pragma once

#include "apps/cli/verb.h"
#include "apps/kinalign/verbs/inputs.h"

#include <string>
#include <vector>

namespace kinalign {

/// The streams of a manifest, of a recording (all devices of which rows can be made) or of a single
/// stream's file.
Result<Input> open_motion(const std::string& path, Call& call);

/// What the reader found amiss in a stream that was read to its end: a line for each warning or
/// error, as `kinalign check` says it.
std::vector<std::string> warnings_of(const RecordedStream& stream);

}  // namespace kinalign
