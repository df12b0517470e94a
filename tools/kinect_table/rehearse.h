// SPDX-License-Identifier: Apache-2.0
// The data that a simulated Kinect would give for UI-PRMD's truth.
#pragma once

#include "tools/kinect_table/repetitions.h"

#include "kinalign/simulate/kinect/kinect_camera.h"

namespace kinalign {

/// The same repetitions with simulated joints. The truth is moved onto them take by take, as the
/// protocol does.
std::vector<Repetition> rehearsed(const std::vector<Repetition>& pieces, const KinectParts& parts,
                                  std::uint64_t seed);

}  // namespace kinalign
