// SPDX-License-Identifier: Apache-2.0
// Table 8, the errors over time and the moving bodies: the page's part about methods that clean a
// Kinect.
#pragma once

#include "apps/kinalign/benchmark/cleaning.h"

#include "kinalign/view/models_page/models_page.h"

#include <vector>

namespace kinalign {

/// Rows: the Kinect, each method (not steadied), the truth. Columns: an instant each of standing,
/// waving, bending, turning right and turning left, chosen by the truth of all tested takes.
/// Only the truth chooses the instants, so no method can be favoured by the choice.
PosePictures pose_table(const CleaningData& data, const std::vector<CleanedTakes>& all);

/// The errors over the longest tested stretch, as means over half a second.
ErrorPlot error_plot(const CleaningData& data, const std::vector<CleanedTakes>& all);

/// The first half minute of the longest tested stretch: the truth, the Kinect, each method (not
/// steadied). Fingers are left out.
/// The bodies of the page's player. They have one clock, so all pictures turn and move together.
SideBySide side_by_side(const CleaningData& data, const std::vector<CleanedTakes>& all);

}  // namespace kinalign
