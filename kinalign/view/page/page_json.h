// SPDX-License-Identifier: Apache-2.0
// What a page's script reads: names and figures as JSON, long series packed (packed_series.h).
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>

namespace kinalign {

/// One JSON object, safe inside a <script> of HTML: no '<' stands in it.
std::string page_json(const TakePage& page);

}  // namespace kinalign
