// SPDX-License-Identifier: Apache-2.0
// Reads and writes recording.toml, the description of a recording (docs/formats/recording_toml.md).
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/manifest.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Reads a manifest. Streams keep the order of the file. `name` appears in messages only. Fails
/// with the line and the nearest known key if a key is unknown, a type is wrong or a value is out
/// of range. `unsaid`: values of the options that [align] does not set.
Result<Manifest> read_manifest(std::string_view toml, std::string_view name,
                               const AlignOptions& unsaid = {});

/// Returns text from which read_manifest() gives `manifest` again. It contains all values that
/// differ from the defaults. A Manifest contains no comments, so comments of a file are not kept.
std::string manifest_toml(const Manifest& manifest);

/// Return lines of one table [stream.NAME], without line ends: `file = ...` or `files = ...`, and
/// `select = ...`.
std::string files_toml(const std::vector<StreamFile>& files);
std::string select_toml(const std::map<std::string, std::string>& select);

}  // namespace kinalign
