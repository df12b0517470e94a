// SPDX-License-Identifier: Apache-2.0
// The part of the page about methods that clean a Kinect: table 8, the errors over time and the
// moving bodies.
#pragma once

#include "apps/kinalign/benchmark/cleaning.h"

#include "kinalign/view/models_page/models_page.h"

#include <vector>

namespace kinalign {

/// Makes table 8. Its rows are the Kinect, each method (not steadied) and the truth. Its columns
/// are moments of standing, waving, bending, turning right and turning left. Only the truth decides
/// which moments are shown, so the choice favours no method.
PosePictures pose_table(const CleaningData& data, const std::vector<CleanedTakes>& all);

/// Plots the errors over the longest tested stretch, as means over half a second.
ErrorPlot error_plot(const CleaningData& data, const std::vector<CleanedTakes>& all);

/// Makes the moving bodies of the page: the first half minute of the longest tested stretch, for
/// the truth, the Kinect and each method (not steadied). Fingers are left out. All bodies move and
/// turn together.
SideBySide side_by_side(const CleaningData& data, const std::vector<CleanedTakes>& all);

}  // namespace kinalign
