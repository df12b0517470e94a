// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/ui_prmd_files.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

// The pairs of words in names of files and folders. Both spellings occur.
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> words{
    {{"positions", "angles"}, {"Positions", "Angles"}}};

/// Replaces the last "positions" in `name` by "angles". Without this word, `name` stays unchanged.
std::string angles_for(std::string_view name) {
  std::string out(name);
  for (const auto& [positions, angles] : words) {
    // The last one is replaced, because the name may contain the word twice.
    const auto at = out.rfind(positions);
    if (at != std::string::npos) return out.replace(at, positions.size(), angles);
  }
  return out;
}

/// Replaces the folder "a/Positions/" by "a/Angles/". Other folders stay unchanged.
std::string angles_folder(std::string_view path) {
  const std::string_view whole = folder(path);
  // The last folder without its slash.
  const std::string_view name = file_name(whole.substr(0, whole.empty() ? 0 : whole.size() - 1));
  for (const auto& [positions, angles] : words) {
    if (name != positions) continue;
    const std::size_t before = whole.size() - 1 - name.size();
    return std::string(whole.substr(0, before)) + std::string(angles) + "/";
  }
  return std::string(whole);
}

std::string angles_path(std::string_view path) {
  return angles_folder(path) + angles_for(file_name(path));
}

}  // namespace

bool named_as_ui_prmd_positions(std::string_view path) { return angles_path(path) != path; }

bool named_as_ui_prmd_angles(std::string_view path) {
  // "..._positions_angles.txt" is a file of positions.
  if (named_as_ui_prmd_positions(path)) return false;
  const std::string_view name = file_name(path);
  return std::any_of(words.begin(), words.end(), [name](const auto& word) {
    return name.find(word.second) != std::string_view::npos;
  });
}

Result<std::string> ui_prmd_angles_of(FileSystem& files, const std::string& path) {
  if (!named_as_ui_prmd_positions(path)) {
    return refuse(
        path,
        "UI-PRMD's file of positions, ..._positions.txt; the file of angles is found by its name",
        named_as_ui_prmd_angles(path) ? "the file of angles" : "another name");
  }
  std::string usual_path = angles_path(path);
  const std::string here = std::string(folder(path)) + angles_for(file_name(path));
  // The folder Angles is tried first, and then the same folder.
  auto opened = InputFile::open(files, usual_path);
  if (opened) return usual_path;
  if (here != path && InputFile::open(files, here)) return here;
  return Failure(std::move(opened).error());
}

}  // namespace kinalign
