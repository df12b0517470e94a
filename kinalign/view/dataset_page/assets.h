// SPDX-License-Identifier: Apache-2.0
// The constant parts of the page. The build embeds them in the library (cmake/embed_page.cmake).
#pragma once

#include <string_view>

namespace kinalign {

// All functions return constant texts in the program.
std::string_view dataset_script();    // assets/table.js
std::string_view dataset_style();     // assets/dataset.css, used after the style of a take's page
std::string_view dataset_template();  // assets/dataset.html

}  // namespace kinalign
