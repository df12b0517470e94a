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

/// The steps of an act. Foot k (alternating, the act's side first) leaves the floor at first_s + k
/// stride_s / 2 and is in the air for swing_s.
/// Both feet and the body go by these times, so they agree without asking each other.
struct StepTimes {
  double first_s = 0.0, stride_s = 1.0, swing_s = 0.4;
  std::size_t count = 0;

  double leaves(std::size_t k) const { return first_s + 0.5 * stride_s * static_cast<double>(k); }
  double lands(std::size_t k) const { return leaves(k) + swing_s; }
  double stance_s() const { return stride_s - swing_s; }
};
/// The step times of an act; none for an act without steps, or one too short for two.
StepTimes step_times(const Act& act);

/// The path of the body, four times continuously differentiable. The body rests outside of the
/// steps. It then stands at home if there was time to go there: at 0, 0, facing +z (yaw a multiple
/// of a turn).
/// Made once for a whole programme; asking does not change it.
class BodyPath {
 public:
  /// `scale`: the person's size; 1: 1.75 m.
  BodyPath(const std::vector<Act>& acts, std::uint64_t seed, double scale);

  FloorPlace at(double t) const { return {x_.at(t), z_.at(t), yaw_.at(t)}; }

 private:
  ControlTrack x_, z_, yaw_;
};

}  // namespace kinalign
