// SPDX-License-Identifier: Apache-2.0
// Position and heading of a simulated person on the floor, and the times of the steps.
#pragma once

#include "kinalign/simulate/person/programme.h"
#include "kinalign/simulate/smooth.h"

namespace kinalign {

struct FloorPlace {
  double x = 0.0, z = 0.0;  // m
  double yaw = 0.0;         // rad about +y from facing +z, not wrapped
};

/// The times of the steps in one act (a part of the programme). The feet alternate; act.side is the
/// first foot. Foot k leaves the floor at first_s + k stride_s / 2 and is in the air for swing_s.
/// Feet and body use the same times, so their movements agree.
struct StepTimes {
  double first_s = 0.0, stride_s = 1.0, swing_s = 0.4;
  std::size_t count = 0;

  double leaves(std::size_t k) const { return first_s + 0.5 * stride_s * static_cast<double>(k); }
  double lands(std::size_t k) const { return leaves(k) + swing_s; }
  double stance_s() const { return stride_s - swing_s; }
};
/// Returns the step times of an act. There are none if the act has no steps or is too short for two
/// steps.
StepTimes step_times(const Act& act);

/// The path of the body, four times continuously differentiable. The body moves only during the
/// steps. If there was time to return, it then stands at the origin, facing +z (yaw is a multiple
/// of a full turn). The path is made once for a whole programme and does not change.
class BodyPath {
 public:
  /// `scale`: size of the person; 1 means 1.75 m.
  BodyPath(const std::vector<Act>& acts, std::uint64_t seed, double scale);

  FloorPlace at(double t) const { return {x_.at(t), z_.at(t), yaw_.at(t)}; }

 private:
  ControlTrack x_, z_, yaw_;
};

}  // namespace kinalign
