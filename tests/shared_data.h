// SPDX-License-Identifier: Apache-2.0
// Real recordings for tests. They are no part of the repository: a case that needs them is
// `* doctest::skip(!shared_data())` and shows in the count.
#pragma once

#include "tests/folder.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace kinalign {

inline std::string shared_path(std::string_view name) {
  return std::string(KINALIGN_SOURCE_DIR) + "/../shared/data/" + std::string(name);
}

inline bool shared_data() { return std::filesystem::is_directory(shared_path("bvh")); }

inline std::string shared_text(std::string_view name) { return bytes_in(shared_path(name)); }

}  // namespace kinalign
