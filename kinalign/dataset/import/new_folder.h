// SPDX-License-Identifier: Apache-2.0
// A folder that comes to be only when all its files are there, so that an import that fails or is
// stopped leaves nothing half done.
#pragma once

#include "kinalign/core/files.h"

#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

/// Puts a file into the folder, in folders of its own where `name` has them.
using PutFile = std::function<Result<OutputFile>(const std::string& name)>;

/// The folder `parent`/STEM-HASH of what `source` is unpacked to; the hash is the file's, so that
/// the same source is unpacked once. `fill` is called where the folder is not there yet.
Result<std::string> unpacked_folder(FileSystem& files, const std::string& parent,
                                    const std::string& source,
                                    const std::function<Result<void>(const PutFile&)>& fill);

}  // namespace kinalign
