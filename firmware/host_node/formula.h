// SPDX-License-Identifier: Apache-2.0
// The readings of the simulated sensor, so that a receiver can check that they came through.
#pragma once

#include "kinalign/wire/node_sample.h"

namespace kinalign {

/// A node that swings about its x axis, which lies level: after t = counter seconds its angle is
/// a = sin(2 pi 0.4 t) rad. World: y up; so at a = 0 gravity reads (0, 9.80665, 0).
///   acceleration (0, g cos a, -g sin a), angular velocity (a', 0, 0), orientation
///   (cos a/2, sin a/2, 0, 0)
NodeSample swing_at(std::uint64_t counter_us, bool with_orientation);

}  // namespace kinalign
