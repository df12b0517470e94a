// SPDX-License-Identifier: Apache-2.0
// What a simulated Kinect would have said of UI-PRMD's truth.
#pragma once

#include "tools/kinect_table/repetitions.h"

#include "kinalign/simulate/kinect/kinect_camera.h"

namespace kinalign {

/// The same pieces with simulated joints, the truth moved onto them take by take as the protocol
/// does it.
std::vector<Repetition> rehearsed(const std::vector<Repetition>& pieces, const KinectParts& parts,
                                  std::uint64_t seed);

}  // namespace kinalign
