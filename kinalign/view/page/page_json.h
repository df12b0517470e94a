// SPDX-License-Identifier: Apache-2.0
// The JSON that a page's script reads: names and figures, and long series packed (packed_series.h).
#pragma once

#include "kinalign/view/page/take_page.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// "mocap", "kinect", "imu": as the style sheet names colours.
std::string_view to_string(PageColour colour);

/// A series [rows,columns], packed, as assets/data.js reads it. Numbers are rounded to `step`.
nlohmann::ordered_json series_json(const std::vector<float>& values, std::size_t columns,
                                   double step);
nlohmann::ordered_json series_json(const std::vector<std::uint8_t>& values, std::size_t columns);

/// JSON with each '<' as \\u003c: it may stand inside a <script> of HTML.
std::string safe_in_script(const std::string& json);

/// One JSON object, safe inside a <script> of HTML: no '<' stands in it.
std::string page_json(const TakePage& page);

}  // namespace kinalign
