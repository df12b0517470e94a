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

/// A function that creates a file in the folder; subfolders in `name` are created, too.
using PutFile = std::function<Result<OutputFile>(const std::string& name)>;
using FillFolder = std::function<Result<void>(const PutFile& put)>;

/// The folder `parent`/STEM-HASH with the content of `source`. The hash is that of the file, so the
/// same source always has the same folder. If the folder exists, only missing files are added
/// (`dataset rm --raw` may have removed them); all other files stay.
Result<std::string> unpacked_folder(FileSystem& files, const std::string& parent,
                                    const std::string& source, const FillFolder& fill);

/// Like unpacked_folder(), but for content from several files. `sha256`: a hash of all data that
/// decide the content.
Result<std::string> filled_folder(FileSystem& files, const std::string& parent,
                                  const std::string& stem, const std::string& sha256,
                                  const FillFolder& fill);

}  // namespace kinalign
