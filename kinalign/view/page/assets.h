// SPDX-License-Identifier: Apache-2.0
// The fixed parts of a page; the build embeds them in the library (cmake/embed_page.cmake).
#pragma once

#include <string_view>

namespace kinalign {

// All are constant texts in the program.
std::string_view page_script();    // assets/main.js with all that it imports
std::string_view page_style();     // assets/page.css
std::string_view page_template();  // assets/page.html
std::string_view page_licences();  // for the libraries in the script

/// The Debian packages that were missing when kinalign was built, so that there is no script:
/// "esbuild, node-d3". Empty: none.
std::string_view page_parts_missing();

}  // namespace kinalign
