// SPDX-License-Identifier: Apache-2.0
// A small picture of one instant: the skeletons and markers of a take drawn over each other.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <vector>

namespace kinalign {

/// An <svg> element of one row of each body (K = 1), seen from the side from which the pose is
/// widest. Bones are red, green or blue by PageBody::colour, dashed where an end is inferred, and
/// left out where an end is missing. A joint without bones, as markers are, is a dot, pale where it
/// is inferred. Bodies outside the take's space are not drawn. Empty where nothing can be drawn.
std::string skeleton_svg(const std::vector<PageBody>& bodies);

}  // namespace kinalign
