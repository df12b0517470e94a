// SPDX-License-Identifier: Apache-2.0
// Real recordings for tests. They are no part of the repository: a case that needs them is
// `* doctest::skip(!shared_data())` and shows in the count.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

inline std::string shared_path(std::string_view name) {
  return std::string(KINALIGN_SOURCE_DIR) + "/../shared/data/" + std::string(name);
}

inline bool shared_data() { return std::filesystem::is_directory(shared_path("bvh")); }

inline std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::string shared_text(std::string_view name) { return text_of(shared_path(name)); }
