# SPDX-License-Identifier: Apache-2.0
# Writes layouts/*.toml into a source file, so that a program that was not installed has them too:
#   cmake -DOUT=builtin_layouts.cpp -DFILES=a.toml,b.toml -P embed_layouts.cmake
string(REPLACE "," ";" FILES "${FILES}")
set(entries "")
foreach(path IN LISTS FILES)
  get_filename_component(name "${path}" NAME_WE)
  file(READ "${path}" text)
  string(APPEND entries "    {\"${name}\", R\"layout(${text})layout\"},\n")
endforeach()
file(WRITE "${OUT}" "// Made from layouts/*.toml by cmake/embed_layouts.cmake.
#include \"kinalign/formats/table/layout.h\"

#include <utility>

namespace kinalign {

namespace {
constexpr std::pair<std::string_view, std::string_view> builtin_layouts[] = {
${entries}};
}  // namespace

std::optional<std::string_view> builtin_layout(std::string_view name) {
  for (const auto& [known, text] : builtin_layouts) {
    if (known == name) return text;
  }
  return std::nullopt;
}

std::vector<std::string_view> builtin_layout_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, text] : builtin_layouts) names.push_back(name);
  return names;
}

}  // namespace kinalign
")
