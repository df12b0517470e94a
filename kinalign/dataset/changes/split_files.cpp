// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/split_files.h"

#include "kinalign/dataset/scan.h"

namespace kinalign {

std::map<std::string, Split> splits_in(FileSystem& files, const std::string& folder) {
  std::map<std::string, Split> out;
  const std::string root = folder + "/";
  for (const std::string below : {"", "splits/"}) {
    const std::string place = root + below;
    const auto names = names_in_folder(place);
    if (!names) continue;
    for (const std::string& name : *names) {
      if (!name.ends_with(".json")) continue;
      // Other programs may also keep JSON files here, so a file that is no split is ignored.
      auto split = read_split(files, place + name);
      if (split) out.emplace(below + name, *std::move(split));
    }
  }
  return out;
}

std::vector<SplitFile> splits_naming(FileSystem& files, const std::string& folder,
                                     const std::set<TakeName>& takes) {
  std::vector<SplitFile> out;
  for (const auto& [path, split] : splits_in(files, folder)) {
    // Takes are counted over all parts of the split.
    SplitFile one{path, 0};
    for (const SplitPart& part : split.parts) {
      for (const TakeName& take : part.takes) one.takes += takes.contains(take) ? 1 : 0;
    }
    if (one.takes > 0) out.push_back(one);
  }
  return out;
}

}  // namespace kinalign
