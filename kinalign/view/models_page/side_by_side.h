// SPDX-License-Identifier: Apache-2.0
// The data of moving bodies for the page's script (assets/side_by_side.js).
#pragma once

#include "kinalign/view/models_page/models_page.h"

#include <string>

namespace kinalign {

/// Returns one JSON object without '<', which may be inside a <script> of HTML. Positions are
/// rounded to 1 mm, distances to 0.1 mm.
std::string side_by_side_json(const SideBySide& motion);

}  // namespace kinalign
