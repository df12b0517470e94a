// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/remembered_path.h"

#include "kinalign/core/files.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace kinalign {

namespace {

/// Returns the path's last `count` parts without "..", or all parts if there are fewer. The first
/// slash of an absolute path is removed, so that no name begins with a slash.
std::string tail(const std::string& path, std::size_t count) {
  std::vector<std::string> parts;
  for (const auto& part : std::filesystem::path(path).lexically_normal().relative_path()) {
    if (part != "..") parts.push_back(part.string());
  }
  std::string out;
  for (std::size_t i = parts.size() - std::min(count, parts.size()); i < parts.size(); ++i) {
    out += (out.empty() ? "" : "/") + parts[i];
  }
  return out;
}

/// Returns whether one path is the end of the other, so that both may be the same file.
bool may_be_one(const std::string& a, const std::string& b) {
  const std::string all = "/" + tail(a, SIZE_MAX), other = "/" + tail(b, SIZE_MAX);
  return all.ends_with(other) || other.ends_with(all);
}

/// Returns whether the path is absolute or leads out of the manifest's folder. Such a path depends
/// on one machine and is not stored.
bool leads_out(const std::string& normal) {
  return normal.starts_with('/') || normal == ".." || normal.starts_with("../");
}

}  // namespace

std::string path_in(const std::string& folder, const std::string& path) {
  return path.starts_with('/') ? path : folder + path;
}

std::string remembered_path(const std::string& path) {
  const std::string normal = std::filesystem::path(path).lexically_normal().string();
  return leads_out(normal) ? std::string(file_name(path)) : normal;
}

/// A file outside the folder gets its file name. If another file has that name, as many folders are
/// added as are needed.
std::map<std::string, std::string> remembered_paths(const std::vector<std::string>& paths) {
  std::map<std::string, std::set<std::string>> by_name;  // normal paths by their names
  const auto normal = [](const std::string& path) {
    return std::filesystem::path(path).lexically_normal().string();
  };
  for (const std::string& path : paths) by_name[remembered_path(path)].insert(normal(path));
  std::map<std::string, std::string> out;
  for (const std::string& path : paths) {
    const std::string name = remembered_path(path), own = normal(path);
    out[path] = name;
    // A file inside the manifest's folder keeps its relative path, which is unique.
    if (!leads_out(own)) continue;
    const auto is_shared = [&](std::size_t count) {
      const auto& all = by_name[name];
      return std::any_of(all.begin(), all.end(), [&](const std::string& other) {
        return !may_be_one(other, own) && tail(other, count) == tail(own, count);
      });
    };
    // Paths that differ only in higher folders keep the same name in the take.
    constexpr std::size_t most = 32;
    for (std::size_t count = 1; count <= most; ++count) {
      out[path] = count == 1 ? name : tail(path, count);
      if (!is_shared(count)) break;
    }
  }
  return out;
}

std::string remembered_sibling(const std::string& name, const std::string& path,
                               const std::string& other) {
  const auto step = std::filesystem::path(other).lexically_normal().lexically_relative(
      std::filesystem::path(path).lexically_normal().parent_path());
  // If the paths have no common root, there is no relative path, so only the file's name is used.
  if (step.empty()) return std::string(file_name(other));
  return remembered_path((std::filesystem::path(name).parent_path() / step).string());
}

std::string remembered_path(const std::string& folder, const std::string& given,
                            const std::string& path) {
  // If the file is not inside the manifest's folder, only the file's name is used.
  const bool below = !given.starts_with('/') && path.starts_with(folder);
  return below ? remembered_path(path.substr(folder.size())) : std::string(file_name(path));
}

}  // namespace kinalign
