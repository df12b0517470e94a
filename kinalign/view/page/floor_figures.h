// SPDX-License-Identifier: Apache-2.0
// The position of a Kinect in a take's space, and the zones on the floor before it (HFUT-MMD paper,
// section 2.2: best 0.8 to 3.5 m, largest 0.5 to 4.5 m; 70 degrees across).
#pragma once

#include "kinalign/take/report.h"
#include "kinalign/view/page/body_figures.h"
#include "kinalign/view/page/take_page.h"

#include <optional>

namespace kinalign {

/// Returns the Kinect's position and direction. Absent if its transform differs from row to row, or
/// if the Kinect looks almost vertically, so that it has no direction along the floor.
std::optional<PageFloor> floor_of(const SpaceReport& space, std::size_t body);

/// Returns the zone of a position in the take's space.
Zone zone_of(const PageFloor& floor, const Vec3& place);

/// Counts the joints of a row by their zones. Missing joints are counted separately.
void count_zones(const JointRows& joints, std::size_t row, PageFloor& floor);

}  // namespace kinalign
