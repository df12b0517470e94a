// SPDX-License-Identifier: Apache-2.0
// The place of a Kinect in a take's space, and the paper's zones on the floor before it (section
// 2.2: best 0.8 to 3.5 m, largest 0.5 to 4.5 m; 70 degrees across).
#pragma once

#include "kinalign/take/report.h"
#include "kinalign/view/page/body_figures.h"
#include "kinalign/view/page/take_page.h"

#include <optional>

namespace kinalign {

/// The Kinect's own place and direction. Absent if its transform differs from row to row, or if it
/// looks up or down so steeply that it has no direction along the floor.
std::optional<PageFloor> floor_of(const SpaceReport& space, std::size_t body);

/// The zone of a place in the take's space.
Zone zone_of(const PageFloor& floor, const Vec3& place);

/// Counts the joints of a row by their zones.
/// Joints at an unknown place are counted apart.
void count_zones(const JointRows& joints, std::size_t row, PageFloor& floor);

}  // namespace kinalign
