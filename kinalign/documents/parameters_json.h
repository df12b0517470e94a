// SPDX-License-Identifier: Apache-2.0
// The manifest as JSON, which a take stores and `rebuild` reads. Keys are those of recording.toml.
// Options with default values are written too, so that a later version with other defaults makes
// the same take.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/manifest.h"

#include <string>
#include <string_view>

namespace kinalign {

/// The keys in a fixed order, every number exact; ends with a line end.
/// The same manifest always gives the same bytes; kinalign/dataset hashes them.
std::string parameters_json(const Manifest& manifest);

/// Parses the text of parameters_json(). Unknown keys, wrong types and values out of range are
/// refused with the path of the key: "streams[0].gap".
Result<Manifest> parse_parameters_json(std::string_view json);

/// The manifest without paths of one machine: they become the names that a take stores
/// (remembered_path.h).
/// Called before a take is written, so that a take tells nothing of its author's machine.
Manifest without_folders(Manifest manifest);

}  // namespace kinalign
