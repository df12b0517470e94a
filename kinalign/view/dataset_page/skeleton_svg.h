// SPDX-License-Identifier: Apache-2.0
// A small picture of one instant: all skeletons and markers of a take in one drawing.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <vector>

namespace kinalign {

/// An <svg> element with one row of each body (K = 1), seen from the side from which the pose is
/// widest. Bones have the colour of PageBody::colour; they are dashed if an end is inferred, and
/// left out if an end is missing. A joint without bones, such as a marker, is a dot, pale if
/// inferred. Bodies outside the take's space are not drawn. Empty if there is nothing to draw.
std::string skeleton_svg(const std::vector<PageBody>& bodies);

}  // namespace kinalign
