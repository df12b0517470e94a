// SPDX-License-Identifier: Apache-2.0
// A small picture of one moment: all skeletons and markers of a take in one drawing.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <vector>

namespace kinalign {

/// Returns an <svg> element with one row of each body (K = 1). The view is from the side from which
/// the pose is widest. Bones have the colour of PageBody::colour. A bone is dashed if an end is
/// inferred, and omitted if an end is missing. A joint without bones, such as a marker, is a dot,
/// which is pale if inferred. Bodies outside the take's space are not drawn. Empty if nothing is
/// drawn.
std::string skeleton_svg(const std::vector<PageBody>& bodies);

}  // namespace kinalign
