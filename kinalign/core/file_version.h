// SPDX-License-Identifier: Apache-2.0
// Whether two names mean one file, and whether a file has stayed as it was.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// Changes whenever someone writes to the file or puts another one in its place.
struct FileVersion {
  std::uint64_t device = 0, number = 0, size = 0;
  std::int64_t changed_ns = 0;  // when its contents last did

  bool operator==(const FileVersion&) const = default;
};

/// Of the file that a path leads to now, links followed; empty where there is none.
std::optional<FileVersion> version_of(const std::string& path);

/// Whether both paths lead to one file that is there.
bool same_file(const std::string& a, const std::string& b);

}  // namespace kinalign
