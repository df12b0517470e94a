// SPDX-License-Identifier: Apache-2.0
// The JSON for a page's script: names, figures, and long series in packed form (packed_series.h).
#pragma once

#include "kinalign/view/page/take_page.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Returns "mocap", "kinect" or "imu", the colour's name in the style sheet.
std::string_view to_string(PageColour colour);

/// Returns a series [rows,columns], packed for assets/data.js. Numbers are rounded to `step`.
nlohmann::ordered_json series_json(const std::vector<float>& values, std::size_t columns,
                                   double step);
nlohmann::ordered_json series_json(const std::vector<std::uint8_t>& values, std::size_t columns);

/// Returns the JSON with each '<' written as \\u003c, so that it may be inside a <script> of HTML.
std::string safe_in_script(const std::string& json);

/// Returns one JSON object without '<', which may be inside a <script> of HTML. Numbers have the
/// units of TakePage. assets/data.js unpacks the series.
std::string page_json(const TakePage& page);

}  // namespace kinalign
