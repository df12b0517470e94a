// SPDX-License-Identifier: Apache-2.0
// A folder that appears only when all its files are complete, so that a failed or stopped import
// leaves nothing unfinished.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/scan.h"

#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

/// Creates a file in the folder; subfolders in `name` are made.
using PutFile = std::function<Result<OutputFile>(const std::string& name)>;
using FillFolder = std::function<Result<void>(const PutFile& put)>;

/// The folder `parent`/STEM-HASH for the content of `source`. The hash is the file's, so the same
/// source always has the same folder. If the folder exists, only missing files are added (dataset
/// rm --raw removed them), and all others stay.
Result<std::string> unpacked_folder(FileSystem& files, const std::string& parent,
                                    const std::string& source, const FillFolder& fill);

/// The same for content made from several files. `sha256`: a hash of everything that it depends on.
Result<std::string> filled_folder(FileSystem& files, const std::string& parent,
                                  const std::string& stem, const std::string& sha256,
                                  const FillFolder& fill);

}  // namespace kinalign
