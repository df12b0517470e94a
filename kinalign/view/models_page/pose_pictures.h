// SPDX-License-Identifier: Apache-2.0
// Pictures of poses as HTML: a table whose cells are drawn from one direction and in one scale.
#pragma once

#include "kinalign/view/models_page/models_page.h"

#include <string>

namespace kinalign {

/// The camera stands before a person who looks to +z, 25 degrees to the person's left and 8 degrees
/// above the horizon. Bones with an inferred end are dashed; bones with a missing end are left out.
/// Empty without a picture.
/// The answers of all methods can be compared only because nothing differs but the poses.
std::string pictures_html(const PosePictures& pictures);

}  // namespace kinalign
