// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/remembered_path.h"

#include "kinalign/core/files.h"

#include <filesystem>

namespace kinalign {

std::string path_in(const std::string& folder, const std::string& path) {
  return path.starts_with('/') ? path : folder + path;
}

std::string remembered_path(const std::string& path) {
  const std::string normal = std::filesystem::path(path).lexically_normal().string();
  const bool leads_out = normal.starts_with('/') || normal == ".." || normal.starts_with("../");
  return leads_out ? std::string(file_name(path)) : normal;
}

std::string remembered_path(const std::string& folder, const std::string& given,
                            const std::string& path) {
  const bool below = !given.starts_with('/') && path.starts_with(folder);
  return below ? remembered_path(path.substr(folder.size())) : std::string(file_name(path));
}

}  // namespace kinalign
