// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/split_files.h"

#include "kinalign/dataset/split.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_split = std::size_t{64} << 20;

}  // namespace

std::vector<SplitFile> splits_naming(FileSystem& files, const std::string& folder,
                                     const std::set<TakeName>& takes) {
  std::vector<SplitFile> out;
  for (const std::string below : {"", "splits/"}) {
    std::error_code fault;
    for (const auto& entry : fs::directory_iterator(folder + "/" + below, fault)) {
      if (entry.path().extension() != ".json") continue;
      const std::string path = below + entry.path().filename().string();
      const auto text = read_whole(files, folder + "/" + path, longest_split);
      const auto split = text ? parse_split_json(*text, path) : Failure(text.error());
      if (!split) continue;
      SplitFile one{path, 0};
      for (const SplitPart& part : split->parts) {
        for (const TakeName& take : part.takes) one.takes += takes.contains(take) ? 1 : 0;
      }
      if (one.takes > 0) out.push_back(one);
    }
  }
  std::sort(out.begin(), out.end(),
            [](const SplitFile& a, const SplitFile& b) { return a.path < b.path; });
  return out;
}

}  // namespace kinalign
