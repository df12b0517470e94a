# SPDX-License-Identifier: Apache-2.0
# Writes the parts of a page into a source file (assets.h of the room):
#   cmake -DOUT=page_assets.cpp -DROOM=view/page -DFOLDER=assets -DPARTS=page_style:page.css,... [-DMISSING=names]
#     -P embed_page.cmake
# A part is a function and its file, in FOLDER or anywhere. esbuild writes ASCII alone. No part may hold the end of a
# literal, )page".
string(REPLACE "," ";" parts "${PARTS}")
set(functions "")
foreach(part IN LISTS parts)
  string(REGEX MATCH "^([a-z_]+):(.*)$" found "${part}")
  set(function ${CMAKE_MATCH_1})
  cmake_path(ABSOLUTE_PATH CMAKE_MATCH_2 BASE_DIRECTORY "${FOLDER}" OUTPUT_VARIABLE file)
  file(READ "${file}" text)
  string(APPEND functions "std::string_view ${function}() { return R\"page(${text})page\"; }\n")
endforeach()
if(DEFINED MISSING)
  string(APPEND functions "std::string_view page_parts_missing() { return \"${MISSING}\"; }\n")
endif()
file(WRITE "${OUT}" "// Made from kinalign/${ROOM}/assets by cmake/embed_page.cmake.
#include \"kinalign/${ROOM}/assets.h\"

namespace kinalign {

${functions}
}  // namespace kinalign
")
