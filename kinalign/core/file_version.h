// SPDX-License-Identifier: Apache-2.0
// Tells whether two paths are the same file, and whether a file has changed.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// Changes whenever the file is written or replaced.
/// Device and number identify the file, size and time its contents. A file that is replaced gets
/// another number, and a file that is written gets another time.
struct FileVersion {
  std::uint64_t device = 0, number = 0, size = 0;
  std::int64_t changed_ns = 0;  // time of the last change of its contents

  bool operator==(const FileVersion&) const = default;
};

/// The version of the file at `path`, links followed; empty if there is none.
std::optional<FileVersion> version_of(const std::string& path);

/// Fails if the file at `path` no longer has the version `version`. A take contains the hashes of
/// its inputs, so every pass must read the bytes that were hashed.
Result<void> unchanged(const std::string& path, const std::optional<FileVersion>& version);

/// True if both paths lead to the same existing file.
bool same_file(const std::string& a, const std::string& b);

}  // namespace kinalign
