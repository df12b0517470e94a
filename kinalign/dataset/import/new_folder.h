// SPDX-License-Identifier: Apache-2.0
// A folder that comes to be only when all its files are there, so that an import that fails or is
// stopped leaves nothing half done.
#pragma once

#include "kinalign/core/files.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A folder that is not there yet. Unless it is kept, it is removed at the end with all that is in
/// it, and so are the folders above it that were not there.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(std::string path);
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  ~UnfinishedFolder();

  void keep() { kept_ = true; }

 private:
  std::string path_;
  std::vector<std::string> above_;  // the deepest first
  bool kept_ = false;
};

/// Puts a file into the folder, in folders of its own where `name` has them.
using PutFile = std::function<Result<OutputFile>(const std::string& name)>;
using FillFolder = std::function<Result<void>(const PutFile& put)>;

/// The folder `parent`/STEM-HASH of what `source` is unpacked to; the hash is the file's, so that
/// the same source has one folder. If the folder is there already, files that it lacks are put into
/// it (dataset rm --raw removed them), and all others stay as they are.
Result<std::string> unpacked_folder(FileSystem& files, const std::string& parent,
                                    const std::string& source, const FillFolder& fill);

/// The same of what is made of several files: `sha256` is over all that it depends on.
Result<std::string> filled_folder(FileSystem& files, const std::string& parent,
                                  const std::string& stem, const std::string& sha256,
                                  const FillFolder& fill);

}  // namespace kinalign
