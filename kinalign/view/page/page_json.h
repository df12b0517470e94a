// SPDX-License-Identifier: Apache-2.0
// The JSON that a page's script reads: names and figures, and long series packed (packed_series.h).
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// "mocap", "kinect", "imu": as the style sheet names colours.
std::string_view to_string(PageColour colour);

/// One JSON object, safe inside a <script> of HTML: no '<' stands in it.
std::string page_json(const TakePage& page);

}  // namespace kinalign
