// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/floor_figures.h"

#include <cmath>
#include <numbers>

namespace kinalign {

std::optional<PageFloor> floor_of(const SpaceReport& space, std::size_t body) {
  // With other methods each row has its own transform, so the Kinect has no single position.
  if (space.method != "fit" && space.method != "given") return std::nullopt;
  PageFloor floor;
  floor.body = body;
  floor.camera = space.transform.translation;
  // A Kinect looks along its own z axis.
  Vec3 forward = space.transform.rotation * Vec3::UnitZ();
  forward.y() = 0.0;
  constexpr double shortest = 0.1;  // length along the floor; 0.1 is 84 degrees up or down
  if (forward.norm() < shortest) return std::nullopt;
  floor.forward = forward.normalized();
  return floor;
}

Zone zone_of(const PageFloor& floor, const Vec3& place) {
  Vec3 from = place - floor.camera;
  from.y() = 0.0;
  const double distance = from.norm();
  // The angle to the Kinect's direction. Near 0, atan2 is exact and acos is not.
  const double across = std::atan2(from.cross(floor.forward).norm(), from.dot(floor.forward));
  if (across > 0.5 * field_deg * std::numbers::pi / 180.0) return Zone::outside;
  if (distance >= best_near_m && distance <= best_far_m) return Zone::best;
  return distance >= largest_near_m && distance <= largest_far_m ? Zone::largest : Zone::outside;
}

// All rows are counted, not only the stored ones.
void count_zones(const JointRows& joints, std::size_t row, PageFloor& floor) {
  for (std::size_t j = 0; j < joints.joints(); ++j) {
    const Tracking state = joints.state(row, j);
    if (state == Tracking::missing) {
      ++floor.missing;
      continue;
    }
    auto& counts = floor.zones[static_cast<std::size_t>(zone_of(floor, joints.at(row, j)))];
    ++(state == Tracking::tracked ? counts.tracked : counts.inferred);
  }
}

}  // namespace kinalign
