# SPDX-License-Identifier: Apache-2.0
# Writes the parts of a page into a source file (kinalign/view/page/assets.h):
#   cmake -DOUT=page_assets.cpp -DSCRIPT=page.js -DASSETS=assets -DMISSING=names -P embed_page.cmake
# esbuild writes ASCII alone. No part may hold the end of a literal, )page".
foreach(part SCRIPT:${SCRIPT} STYLE:${ASSETS}/page.css HTML:${ASSETS}/page.html LICENCES:${ASSETS}/licences.txt)
  string(REGEX MATCH "^([A-Z]+):(.*)$" found "${part}")
  file(READ "${CMAKE_MATCH_2}" ${CMAKE_MATCH_1}_TEXT)
endforeach()
file(WRITE "${OUT}" "// Made from kinalign/view/page/assets by cmake/embed_page.cmake.
#include \"kinalign/view/page/assets.h\"

namespace kinalign {

std::string_view page_script() { return R\"page(${SCRIPT_TEXT})page\"; }
std::string_view page_style() { return R\"page(${STYLE_TEXT})page\"; }
std::string_view page_template() { return R\"page(${HTML_TEXT})page\"; }
std::string_view page_licences() { return R\"page(${LICENCES_TEXT})page\"; }
std::string_view page_parts_missing() { return \"${MISSING}\"; }

}  // namespace kinalign
")
