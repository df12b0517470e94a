// SPDX-License-Identifier: Apache-2.0
// Lists the files of takes in a data set's folder, and removes files and unfinished folders. No
// function throws: a folder that can't be entered is an Error.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/dataset/take_summary.h"

#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// Limits of the sizes of these files, bytes. Larger files are refused.
inline constexpr std::size_t longest_summary = std::size_t{1} << 20;
inline constexpr std::size_t longest_manifest = std::size_t{4} << 20;

/// True if a file or folder exists. False if it does not exist or if this can't be found out.
bool is_there(const std::string& path);
/// Removes a file. If it does not exist, this is no error.
Result<void> remove_file(FileSystem& files, const std::string& path);

/// Removes a folder if it exists and is empty.
void remove_if_empty(const std::string& path);

/// A new folder. Unless keep() is called, the folder is removed at the end with all its files, and
/// so are its parent folders that did not exist before.
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

/// The names in a folder, sorted. Fails if it can't be read.
Result<std::vector<std::string>> names_in_folder(const std::string& path);
/// The names of people's folders, "sub-03". Fails if the data set's folder can't be read.
Result<std::vector<std::string>> people_in(const std::string& folder);

/// The files that a take has. A take that was not built has only a manifest. A take that was added
/// without raw files has no manifest.
struct TakeFiles {
  bool manifest = false, take = false, summary = false;
};

/// The files of all takes. Fails if the folder, or a folder in it, can't be read.
Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder);
/// The files of one person's takes. The person's folder must exist.
Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder,
                                                 const std::string& subject);

/// Reads the summary next to a take.
Result<TakeSummary> read_summary(FileSystem& files, const std::string& folder,
                                 const TakeName& name);

}  // namespace kinalign
