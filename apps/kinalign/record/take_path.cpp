// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/take_path.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <set>

namespace kinalign {

namespace {

/// Replaces each character that is not allowed in a file's name by '-'. Subject and action may
/// contain spaces, '/' and letters of any language.
std::string in_name(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    out += plain || c == '-' ? c : '-';
  }
  return out;
}

/// The names of takes that have several parts: "take_01.part2.mcap" gives "take_01". Empty if the
/// folder can't be listed.
std::set<std::string> names_with_parts(const std::string& folder) {
  std::set<std::string> names;
  // In a folder that does not exist all names are free.
  std::error_code fault;
  std::filesystem::directory_iterator entry(folder, fault);
  for (; !fault && entry != std::filesystem::directory_iterator(); entry.increment(fault)) {
    const std::string name = entry->path().filename().string();
    const std::size_t part = name.find(".part");
    // A part may remain after its first file was moved away. Its name must not be used again.
    if (part != std::string::npos && name.ends_with(".mcap")) names.insert(name.substr(0, part));
  }
  return names;
}

}  // namespace

std::string free_take_path(const std::string& folder, const std::string& subject,
                           const std::string& action) {
  std::string name;
  for (const std::string& part : {subject, action}) {
    if (!part.empty()) name += in_name(part) + "_";
  }
  if (name.empty()) name = "take_";
  const std::set<std::string> taken = names_with_parts(folder);
  for (int run = 1;; ++run) {
    // With two digits, names sort well; numbers above 99 have more digits.
    const std::string numbered = fmt::format("{}{:02}", name, run);
    std::string path = fmt::format("{}/{}.mcap", folder, numbered);
    // lstat() also finds a link without a target, whose name is not free either.
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0 && !taken.contains(numbered)) return path;
  }
}

}  // namespace kinalign
