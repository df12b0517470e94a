// SPDX-License-Identifier: Apache-2.0
// The manifest as JSON, which a take stores and `rebuild` reads. The keys are those of
// recording.toml. Options with default values are written too, so that a later version with other
// defaults makes the same take.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/manifest.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Returns the JSON with keys in a fixed order and exact numbers, ending with a line end. The same
/// manifest always gives the same bytes, because kinalign/dataset hashes them.
std::string parameters_json(const Manifest& manifest);

/// Parses the text of parameters_json(). Fails with the path of the key ("streams[0].gap") if a key
/// is unknown, a type is wrong or a value is out of range.
Result<Manifest> parse_parameters_json(std::string_view json);

/// Returns the manifest with the names under which a take stores its files (remembered_path.h).
/// Called before a take is written, so that the take contains no paths of the author's machine.
Manifest without_folders(Manifest manifest);

}  // namespace kinalign
