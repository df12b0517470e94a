// SPDX-License-Identifier: Apache-2.0
// The constant parts of a page. The build embeds them in the library (cmake/embed_page.cmake).
#pragma once

#include <string_view>

namespace kinalign {

// All functions return constant texts in the program.
std::string_view page_script();    // assets/main.js with all files that it imports
std::string_view page_style();     // assets/page.css
std::string_view page_template();  // assets/page.html
std::string_view page_licences();  // licences of the libraries in the script

/// The Debian packages that were missing when kinalign was built, such as "esbuild, node-d3". If
/// any is missing, there is no script. Empty: none is missing.
std::string_view page_parts_missing();

}  // namespace kinalign
