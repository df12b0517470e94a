// SPDX-License-Identifier: Apache-2.0
// The marks of UI-PRMD's protocol (MPJPE, PA-MPJPE, bones, acceleration, jitter), mean over
// repetitions.
#pragma once

#include "tools/kinect_table/figures.h"

namespace kinalign {

void put_marks(const std::vector<Repetition>& pieces, Figures& figures);

}  // namespace kinalign
