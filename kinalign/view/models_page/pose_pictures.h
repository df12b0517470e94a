// SPDX-License-Identifier: Apache-2.0
// Pictures of poses as an HTML table, all with the same scale and viewing direction.
#pragma once

#include "kinalign/view/models_page/models_page.h"

#include <string>

namespace kinalign {

/// Returns the table; empty if there is no picture. The camera is before a person who looks to +z,
/// 25 degrees to the person's left and 8 degrees above the horizon. Bones with an inferred end are
/// dashed; bones with a missing end are omitted. All pictures have the same view and scale, so that
/// the results of methods can be compared.
std::string pictures_html(const PosePictures& pictures);

}  // namespace kinalign
