// SPDX-License-Identifier: Apache-2.0
// Makes the page of a data set: one HTML text without external files. The same DatasetPage always
// gives the same text.
#pragma once

#include "kinalign/view/dataset_page/dataset_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// A tag in the head of every such page. If a file contains it, the program may replace the file.
inline constexpr std::string_view dataset_page_mark =
    "<meta name=\"kinalign-page\" content=\"data set\">";

/// Returns the page. Takes are links to their own pages, which must be at the paths in
/// DatasetTake::page.
std::string dataset_html(const DatasetPage& page);

}  // namespace kinalign
