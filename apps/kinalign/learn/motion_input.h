// SPDX-License-Identifier: Apache-2.0
// Opens the inputs of denoise and pose that are not takes.
#pragma once

#include "apps/cli/verb.h"
#include "apps/kinalign/verbs/inputs.h"

#include <string>
#include <vector>

namespace kinalign {

/// The streams of a manifest, of a recording (all devices of which rows can be made) or of a single
/// stream's file.
/// A device of a recording that can't be read is left out. If it is the wanted one, its name is
/// missing among the streams.
Result<Input> open_motion(const std::string& path, Call& call);

/// The warnings and errors that the reader found in a stream that was read to its end, one line
/// each, in the words of `kinalign check`.
std::vector<std::string> warnings_of(const RecordedStream& stream);

}  // namespace kinalign
