// SPDX-License-Identifier: Apache-2.0
// The page of a data set: one HTML text without external files. The same DatasetPage always gives
// the same text.
#pragma once

#include "kinalign/view/dataset_page/dataset_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// This tag is in the head of every such page; a file that has it may be replaced.
inline constexpr std::string_view dataset_page_mark =
    "<meta name=\"kinalign-page\" content=\"data set\">";

/// Takes are links to their own pages, so those must lie at the paths that DatasetTake::page names.
std::string dataset_html(const DatasetPage& page);

}  // namespace kinalign
