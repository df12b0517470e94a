// SPDX-License-Identifier: Apache-2.0
// recording.toml: the description of a recording. All keys: docs/formats/recording_toml.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/manifest.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Reads a manifest; streams keep the order of the file. `name` appears in messages only. An
/// unknown key, a wrong type or a value out of range is refused with its line and the nearest known
/// key. `unsaid`: the values of options that [align] does not state.
Result<Manifest> read_manifest(std::string_view toml, std::string_view name,
                               const AlignOptions& unsaid = {});

/// The text that reads back as `manifest`, with all values that differ from the defaults.
/// Comments and blank lines of a file are not part of a Manifest, so they are lost.
std::string manifest_toml(const Manifest& manifest);

/// Lines of one [stream.NAME], without line ends: `file = ...` or `files = ...`, and `select =
/// ...`.
std::string files_toml(const std::vector<StreamFile>& files);
std::string select_toml(const std::map<std::string, std::string>& select);

}  // namespace kinalign
