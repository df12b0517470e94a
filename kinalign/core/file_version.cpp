// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/file_version.h"

#include <sys/stat.h>

namespace kinalign {

std::optional<FileVersion> version_of(const std::string& path) {
  // stat() follows links, so a link and its target count as the same file.
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  constexpr std::int64_t second_ns = 1'000'000'000;
  return FileVersion{status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size),
                     status.st_mtim.tv_sec * second_ns + status.st_mtim.tv_nsec};
}

Result<void> unchanged(const std::string& path, const std::optional<FileVersion>& version) {
  if (version_of(path) == version) return {};
  return refuse(path, "a file that does not change while it is read", "a changed file");
}

bool same_file(const std::string& a, const std::string& b) {
  const auto one = version_of(a), other = version_of(b);
  return one && other && one->device == other->device && one->number == other->number;
}

}  // namespace kinalign
