// SPDX-License-Identifier: Apache-2.0
// An artificial person who performs a programme, so that nothing has to be downloaded. The motion
// consists of closed formulas of time over a plan that is drawn once. It is three times
// continuously differentiable and uses the skeleton of perception_neuron.h. Feet don't slide, and
// knees follow by inverse kinematics; the hips are as high as both legs allow. Knees are never
// quite straight: in T-pose they are bent by 9 degrees, each leg 4.5 degrees off the vertical of
// the rest pose.
//
// People's ranges, which tests/simulate/person/built_in_motion_test.cpp checks: the angular rate of
// a swinging shank reaches 300 deg/s (Aminian et al., «Spatio-temporal parameters of gait measured
// by an ambulatory system using miniature gyroscopes», J. Biomech. 35, 2002, figure 2), and that of
// joints in walking 400 (Mentiplay et al., Gait & Posture 65, 2018, at 1.6 m/s; quoted from
// memory). The 500 of a waving forearm and all others are estimates.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/pose.h"
#include "kinalign/simulate/person/programme.h"

#include <optional>

namespace kinalign {

struct BuiltInOptions {
  double height_m = 1.75;
  double length_s = 60.0;  // length of the default programme; used if none is given
  Programme programme{};   // empty: default_programme; a given one is as long as its pieces
  std::uint64_t seed = 1;  // for the person and all that differs from one time to the next
  /// Person of these proportions and style; absent: the seed's.
  std::optional<std::uint64_t> person{};
};

/// y is up and the floor is at y = 0. The person begins at x = z = 0, facing +z, and returns there.
/// Fails if the height is not within 0.5 to 2.5 m, or the length not within 0 to 1e6 s.
Result<Motion> built_in_motion(const BuiltInOptions& options);

}  // namespace kinalign
