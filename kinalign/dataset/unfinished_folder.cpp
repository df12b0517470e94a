// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/unfinished_folder.h"

#include "kinalign/dataset/scan.h"

#include <filesystem>
#include <system_error>
#include <utility>

namespace kinalign {

namespace fs = std::filesystem;

UnfinishedFolder::UnfinishedFolder(std::string path) : path_(std::move(path)) {
  for (fs::path up = fs::path(path_).parent_path(); !up.empty() && !is_there(up.string());
       up = up.parent_path()) {
    // Only folders that do not exist yet are remembered.
    above_.push_back(up.string());
  }
}

UnfinishedFolder::~UnfinishedFolder() {
  // A failed import removes what it made, and no folder that existed before.
  if (kept_) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  for (const std::string& one : above_) fs::remove(one, ignored);  // only if it is empty
}

}  // namespace kinalign
