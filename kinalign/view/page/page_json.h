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

/// "mocap", "kinect", "imu": the colours' names in the style sheet.
std::string_view to_string(PageColour colour);

/// A series [rows,columns], packed for assets/data.js. Numbers are rounded to `step`.
nlohmann::ordered_json series_json(const std::vector<float>& values, std::size_t columns,
                                   double step);
nlohmann::ordered_json series_json(const std::vector<std::uint8_t>& values, std::size_t columns);

/// The JSON with each '<' as \\u003c, so that it may stand inside a <script> of HTML.
std::string safe_in_script(const std::string& json);

/// One JSON object that may stand inside a <script> of HTML: it contains no '<'.
/// Figures are in the units of TakePage; assets/data.js unpacks the series.
std::string page_json(const TakePage& page);

}  // namespace kinalign
