// SPDX-License-Identifier: Apache-2.0
// A folder that appears only when all its files are complete, so that a failed or stopped import
// leaves nothing unfinished.
#pragma once

#include "kinalign/core/files.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A new folder. Unless it is kept, it is removed at the end with all its files, and so are parent
/// folders that did not exist before.
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
