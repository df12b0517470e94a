// SPDX-License-Identifier: Apache-2.0
// Positions of both feet at any time. A foot stands until its next swing begins with the tip of the
// toes. The heel rises before the toes leave the floor. The whole foot lands at once.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/simulate/person/body_path.h"

namespace kinalign {

/// Measures of a foot below the ankle and of the standing position, m.
struct FootShape {
  double height = 0.0;      // height of the ankle above the sole
  double length = 0.0;      // from the ankle forward to the tip of the toes
  double half_apart = 0.0;  // half the distance between standing feet
  double toes_out = 0.0;    // rad; angle by which the toes point outwards
};

struct FootState {
  Vec3 ankle = Vec3::Zero(), toes = Vec3::Zero();  // m
  double yaw = 0.0;                                // rad, not wrapped
  Quat rotation = Quat::Identity();                // global rotation of the foot
  bool planted = true;                             // the toes are on the floor
};

/// The movement of one foot; three times continuously differentiable.
class FootTrack {
 public:
  /// One step through the air. Between two swings the foot stands on the floor.
  struct Swing {
    double leaves_s = 0.0, lands_s = 0.0;
    FloorPlace from, to;    // positions of the toes
    double lift_m = 0.0;    // height of the toes in the middle of the swing, m
    double heel_rad = 0.0;  // angle by which the heel rises, rad
  };
  /// `side`: +1 for the left foot. `scale`: size of the person; 1 means 1.75 m.
  FootTrack(const std::vector<Act>& acts, const BodyPath& path, const FootShape& shape, double side,
            double scale);

  FootState at(double t) const;
  const std::vector<Swing>& swings() const { return swings_; }

 private:
  FootShape shape_;
  FloorPlace start_;
  std::vector<Swing> swings_;  // in the order of time
};

}  // namespace kinalign
