// SPDX-License-Identifier: Apache-2.0
// A person of our own making who does what a programme says, so that nothing has to be downloaded:
// closed formulas of time over a plan that is drawn once, three times continuously differentiable,
// on the skeleton of perception_neuron.h. Feet stand where they stand and knees follow by inverse
// kinematics; hips are as high as both legs allow. Knees are never quite straight: 9 degrees bent
// in T-pose, each leg 4.5 off the vertical of the rest pose.
//
// What people's ranges are, and what is held to (tests/simulate/person/built_in_motion_test.cpp):
// angular rates of a shank that swings reach 300 deg/s (Aminian et al., «Spatio-temporal parameters
// of gait measured by an ambulatory system using miniature gyroscopes», J. Biomech. 35, 2002,
// figure 2) and of joints in walking up to 400 (Mentiplay et al., Gait & Posture 65, 2018, at 1.6
// m/s; recalled); a waving forearm's 500 and the rest are estimates.
#pragma once

#include "kinalign/motion/pose.h"
#include "kinalign/simulate/person/programme.h"

#include <optional>

namespace kinalign {

struct BuiltInOptions {
  double height_m = 1.75;
  double length_s = 60.0;  // of the default programme, where none is given
  Programme programme{};   // empty: default_programme; a given one is as long as its pieces
  std::uint64_t seed = 1;  // of the person and of all that differs from one time to the next
  std::optional<std::uint64_t> person{};  // whose proportions and habits, where not the seed's
};

/// y up, floor at y = 0; the person begins at x = z = 0, facing +z, and comes back there.
/// Fails for a height that is not within 0.5 to 2.5 m, or a length that is not within 0 to 1e6 s.
Result<Motion> built_in_motion(const BuiltInOptions& options);

}  // namespace kinalign
