// SPDX-License-Identifier: Apache-2.0
// Real recordings for tests. They are not in the repository: a case that needs them has `*
// doctest::skip(!shared_data())` and is counted as skipped without them.
#pragma once

#include "tests/folder.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

inline std::string shared_path(std::string_view name) {
  return std::string(KINALIGN_SOURCE_DIR) + "/../shared/data/" + std::string(name);
}

inline bool shared_data() { return std::filesystem::is_directory(shared_path("bvh")); }

/// All real BVH files, except those below wild/, for which each file has its own expectation.
inline std::vector<std::filesystem::path> shared_bvh_files() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(shared_path(""))) {
    const std::string path = entry.path().string();
    const bool is_wild = path.find("/wild/") != std::string::npos;
    if (entry.path().extension() == ".bvh" && !is_wild) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

inline std::string shared_text(std::string_view name) { return bytes_in(shared_path(name)); }

}  // namespace kinalign
