// SPDX-License-Identifier: Apache-2.0
// An artificial person who performs a programme, so that no motion file is needed. The motion is
// computed by formulas of time from a plan that is drawn once. It is three times continuously
// differentiable and uses the skeleton of perception_neuron.h. Feet don't slide, and knees follow
// by inverse kinematics. The hips are as high as both legs allow. Knees are never quite straight:
// in T-pose they are bent by 9 degrees, and thigh and shank are each 4.5 degrees off the vertical
// of the rest pose.
//
// tests/simulate/person/built_in_motion_test.cpp checks these ranges of people. The angular rate of
// a swinging shank reaches 300 deg/s (Aminian et al., «Spatio-temporal parameters of gait measured
// by an ambulatory system using miniature gyroscopes», J. Biomech. 35, 2002, figure 2). The rate of
// joints in walking reaches 400 deg/s (Mentiplay et al., Gait & Posture 65, 2018, at 1.6 m/s;
// quoted from memory). The 500 deg/s of a waving forearm and all other limits are estimates.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/pose.h"
#include "kinalign/simulate/person/programme.h"

#include <optional>

namespace kinalign {

struct BuiltInOptions {
  double height_m = 1.75;
  double length_s = 60.0;  // length of the default programme
  Programme programme{};   // empty: default_programme; otherwise its pieces give the length
  std::uint64_t seed = 1;  // for all that differs between two performances, and for the person
  /// Gives proportions and style of the person; absent: `seed` gives them.
  std::optional<std::uint64_t> person{};
};

/// Returns the motion. y is up and the floor is at y = 0. The person begins at x = z = 0, facing
/// +z, and returns there. Fails if the height is not within 0.5 to 2.5 m, or the length not within
/// 0 to 1e6 s.
Result<Motion> built_in_motion(const BuiltInOptions& options);

}  // namespace kinalign
