// SPDX-License-Identifier: Apache-2.0
// Raw files in a data set: which files below sourcedata/ takes are made of.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/take_inputs.h"
#include "kinalign/dataset/take_name.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

inline constexpr std::string_view raw_files_folder = "sourcedata";

/// The place of a file below the data set's folder, "sourcedata/s05/walk.txt", with all links above
/// the file followed. Absent where the file does not lie below sourcedata/ then.
std::optional<std::string> place_in_sourcedata(const std::string& folder, const std::string& path);

/// The inputs of a take, also of one that was never built. None where the take has no manifest.
/// Fails where the manifest can't be read.
Result<std::vector<TakeInput>> raw_files_of(FileSystem& files, const std::string& folder,
                                            const TakeName& name);

/// Everything below sourcedata/ but folders; no link is followed. Fails where a folder can't be
/// read.
Result<std::vector<std::string>> files_in_sourcedata(const std::string& folder);

}  // namespace kinalign
