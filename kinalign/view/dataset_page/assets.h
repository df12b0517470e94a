// SPDX-License-Identifier: Apache-2.0
// The fixed parts of the page; the build embeds them in the library (cmake/embed_page.cmake).
#pragma once

#include <string_view>

namespace kinalign {

// Constant texts in the program.
std::string_view dataset_script();    // assets/table.js
std::string_view dataset_style();     // assets/dataset.css, after the style of a take's page
std::string_view dataset_template();  // assets/dataset.html

}  // namespace kinalign
