// SPDX-License-Identifier: Apache-2.0
// Tells whether two paths are the same file, and whether a file has changed.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// A value that changes whenever the file is written or replaced. Device and number identify the
/// file, and size and time identify its contents. A replaced file gets another number, and a
/// written file gets another time.
struct FileVersion {
  std::uint64_t device = 0, number = 0, size = 0;
  std::int64_t changed_ns = 0;  // time of the last change of the contents, ns

  bool operator==(const FileVersion&) const = default;
};

/// The version of the file at `path`; empty if there is no file. Symbolic links are followed.
std::optional<FileVersion> version_of(const std::string& path);

/// Fails if the file at `path` no longer has the version `version`. A take contains the hashes of
/// its input files, so each pass over an input must read the bytes that were hashed.
Result<void> unchanged(const std::string& path, const std::optional<FileVersion>& version);

/// True if both paths lead to the same existing file.
bool same_file(const std::string& a, const std::string& b);

}  // namespace kinalign
