// SPDX-License-Identifier: Apache-2.0
// A take names its inputs' hashes: every pass has to see the bytes that were hashed.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/file_version.h"

#include <optional>
#include <string>

namespace kinalign {

/// Fails where the file at `path` is no more the one of `version`.
inline Result<void> unchanged(const std::string& path, const std::optional<FileVersion>& version) {
  if (version_of(path) == version) return {};
  return Failure(Error{path, 0, "a file that stays as it is while it is read", "one that changed"});
}

}  // namespace kinalign
