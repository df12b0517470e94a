// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/scan.h"

#include <filesystem>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

}  // namespace

Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder) {
  std::map<TakeName, TakeFiles> out;
  std::error_code fault;
  for (const fs::directory_entry& person : fs::directory_iterator(folder, fault)) {
    const std::string name = person.path().filename().string();
    if (!name.starts_with("sub-") || !person.is_directory()) continue;
    out.merge(KA_TRY(scan_takes(folder, name.substr(4))));
  }
  if (fault) return Failure(Error{folder, 0, "a folder that can be read", fault.message()});
  return out;
}

Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder,
                                                 const std::string& subject) {
  std::map<TakeName, TakeFiles> out;
  std::error_code fault;
  const std::string name = "sub-" + subject, path = folder + "/" + name;
  for (const fs::directory_entry& file : fs::directory_iterator(path, fault)) {
    const auto parsed = parse_take_path(name + "/" + file.path().filename().string());
    if (!parsed) continue;
    TakeFiles& take = out[parsed->first];
    take.manifest = take.manifest || parsed->second == TakeFile::manifest;
    take.take = take.take || parsed->second == TakeFile::take;
    take.summary = take.summary || parsed->second == TakeFile::summary;
  }
  if (fault) return Failure(Error{path, 0, "a folder that can be read", fault.message()});
  return out;
}

Result<TakeSummary> read_summary(FileSystem& files, const std::string& folder,
                                 const TakeName& name) {
  const std::string path = path_of(name, TakeFile::summary);
  return parse_summary_json(KA_TRY(read_whole(files, folder + "/" + path, longest_summary)), path);
}

}  // namespace kinalign
