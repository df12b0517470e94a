// SPDX-License-Identifier: Apache-2.0
// A take contains the hashes of its inputs, so every pass must read the bytes that were hashed.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/file_version.h"

#include <optional>
#include <string>

namespace kinalign {

/// Fails if the file at `path` no longer has the version `version`.
inline Result<void> unchanged(const std::string& path, const std::optional<FileVersion>& version) {
  if (version_of(path) == version) return {};
  return Failure(Error{path, 0, "a file that does not change while it is read", "a changed file"});
}

}  // namespace kinalign
