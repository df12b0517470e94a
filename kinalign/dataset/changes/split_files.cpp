// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/split_files.h"

#include <filesystem>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

}  // namespace

std::map<std::string, Split> splits_in(FileSystem& files, const std::string& folder) {
  std::map<std::string, Split> out;
  for (const std::string below : {"", "splits/"}) {
    std::error_code fault;
    for (const auto& entry : fs::directory_iterator(fs::path(folder) / below, fault)) {
      if (entry.path().extension() != ".json") continue;
      std::string path = below;
      path += entry.path().filename().string();
      auto split = read_split(files, entry.path().string());
      if (split) out.emplace(std::move(path), *std::move(split));
    }
  }
  return out;
}

std::vector<SplitFile> splits_naming(FileSystem& files, const std::string& folder,
                                     const std::set<TakeName>& takes) {
  std::vector<SplitFile> out;
  for (const auto& [path, split] : splits_in(files, folder)) {
    SplitFile one{path, 0};
    for (const SplitPart& part : split.parts) {
      for (const TakeName& take : part.takes) one.takes += takes.contains(take) ? 1 : 0;
    }
    if (one.takes > 0) out.push_back(one);
  }
  return out;
}

}  // namespace kinalign
