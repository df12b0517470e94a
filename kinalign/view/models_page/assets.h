// SPDX-License-Identifier: Apache-2.0
// The constant parts of the page. The build embeds them in the library (cmake/embed_page.cmake).
#pragma once

#include <string_view>

namespace kinalign {

std::string_view models_style();     // assets/models.css, used after the style of a take's page
std::string_view models_template();  // assets/models.html
std::string_view models_script();    // assets/side_by_side.js; empty without esbuild

}  // namespace kinalign
