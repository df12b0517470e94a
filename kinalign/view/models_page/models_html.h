// SPDX-License-Identifier: Apache-2.0
// The page of a benchmark: one HTML text without external files. The same ModelsPage always gives
// the same text.
#pragma once

#include "kinalign/view/models_page/models_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// This tag is in the head of every such page; a file that has it may be replaced.
inline constexpr std::string_view models_page_mark =
    "<meta name=\"kinalign-page\" content=\"benchmark\">";

/// Everything but the moving bodies works without a script.
std::string models_html(const ModelsPage& page);

}  // namespace kinalign
