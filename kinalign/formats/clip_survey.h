// SPDX-License-Identifier: Apache-2.0
// Results of the first pass over a file of a skeleton whose frames have a fixed time step.
#pragma once

#include "kinalign/take/recording.h"

namespace kinalign {

/// `survey` is computed from the step, so the frames are not read.
struct ClipSurvey {
  Skeleton skeleton;
  StampSurvey survey;
  double step_ns = 0.0;  // from one frame to the next
  InputFacts facts;
  Findings findings;
};

}  // namespace kinalign
