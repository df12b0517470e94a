// SPDX-License-Identifier: Apache-2.0
// Removes a folder that a failed or stopped job leaves unfinished.
#pragma once

#include <string>
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

}  // namespace kinalign
