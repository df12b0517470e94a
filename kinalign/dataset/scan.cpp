// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/scan.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

Failure unreadable(const std::string& folder, const std::error_code& fault) {
  return Failure(Error{folder, 0, "a folder that can be read", fault.message()});
}

}  // namespace

/// The variant with an error code is used, because the other one throws.
bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

Result<void> remove_file(FileSystem& files, const std::string& path) {
  if (files.remove(path.c_str()) == 0 || errno == ENOENT) return {};
  return Failure(Error{path, 0, "a file that can be removed", std::strerror(errno)});
}

void remove_if_empty(const std::string& path) {
  std::error_code ignored;  // not empty, or missing
  if (fs::is_directory(path, ignored)) fs::remove(path, ignored);
}

UnfinishedFolder::UnfinishedFolder(std::string path) : path_(std::move(path)) {
  for (fs::path up = fs::path(path_).parent_path(); !up.empty() && !is_there(up.string());
       up = up.parent_path()) {
    // Only folders that do not exist yet are remembered.
    above_.push_back(up.string());
  }
}

UnfinishedFolder::~UnfinishedFolder() {
  // If the import fails, all new folders are removed. Folders that existed before stay.
  if (kept_) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  for (const std::string& one : above_) fs::remove(one, ignored);  // only if it is empty
}

Result<std::vector<std::string>> names_in_folder(const std::string& path) {
  std::vector<std::string> out;
  std::error_code fault;
  // increment() with an error code does not throw, unlike ++.
  for (fs::directory_iterator at(path, fault), end; !fault && at != end; at.increment(fault)) {
    out.push_back(at->path().filename().string());
  }
  if (fault) return unreadable(path, fault);
  // A folder lists its files in no fixed order.
  std::sort(out.begin(), out.end());
  return out;
}

Result<std::vector<std::string>> people_in(const std::string& folder) {
  std::vector<std::string> out;
  const std::string root = folder + "/";
  for (const std::string& name : KA_TRY(names_in_folder(folder))) {
    if (!name.starts_with("sub-")) continue;
    const std::string path = root + name;
    std::error_code fault;
    // A link to a folder counts as a folder.
    const auto kind = fs::status(path, fault).type();
    // If a person's folder can't be read, this is an error: the takes would be missing without
    // notice.
    if (kind == fs::file_type::none) return unreadable(path, fault);
    if (kind == fs::file_type::directory) out.push_back(name);
  }
  return out;
}

Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder) {
  std::map<TakeName, TakeFiles> out;
  for (const std::string& name : KA_TRY(people_in(folder))) {
    out.merge(KA_TRY(scan_takes(folder, name.substr(4))));
  }
  return out;
}

Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder,
                                                 const std::string& subject) {
  std::map<TakeName, TakeFiles> out;
  const std::string below = "sub-" + subject + "/", path = folder + "/sub-" + subject;
  for (const std::string& file : KA_TRY(names_in_folder(path))) {
    // Other files in the folder do not belong to the data set.
    const auto parsed = parse_take_path(below + file);
    if (!parsed) continue;
    TakeFiles& take = out[parsed->first];
    take.manifest = take.manifest || parsed->second == TakeFile::manifest;
    take.take = take.take || parsed->second == TakeFile::take;
    take.summary = take.summary || parsed->second == TakeFile::summary;
  }
  return out;
}

Result<TakeSummary> read_summary(FileSystem& files, const std::string& folder,
                                 const TakeName& name) {
  const std::string path = path_of(name, TakeFile::summary);
  return parse_summary_json(KA_TRY(read_whole(files, folder + "/" + path, longest_summary)), path);
}

}  // namespace kinalign
