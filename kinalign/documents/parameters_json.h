// SPDX-License-Identifier: Apache-2.0
// The manifest as JSON: what a take remembers of how it was made, and what `rebuild` reads. Keys
// are those of recording.toml; options at their default are written too, so that a later version
// with other defaults makes the same take.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/manifest.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Ordered keys, every number exact; ends in a line end.
std::string parameters_json(const Manifest& manifest);

/// Reads what parameters_json wrote. Unknown keys, wrong types and values out of range are refused
/// with the path of the key: "streams[0].gap".
Result<Manifest> parse_parameters_json(std::string_view json);

/// Without what belongs to one machine: paths as a take remembers them (remembered_path.h).
Manifest without_folders(Manifest manifest);

}  // namespace kinalign
