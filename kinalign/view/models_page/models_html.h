// SPDX-License-Identifier: Apache-2.0
// Makes the page of a benchmark: one HTML text without external files. The same ModelsPage always
// gives the same text.
#pragma once

#include "kinalign/view/models_page/models_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// A tag in the head of every such page. If a file contains it, the program may replace the file.
inline constexpr std::string_view models_page_mark =
    "<meta name=\"kinalign-page\" content=\"benchmark\">";

/// Returns the page. Without a script, everything except the moving bodies works.
std::string models_html(const ModelsPage& page);

}  // namespace kinalign
