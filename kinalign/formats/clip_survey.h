// SPDX-License-Identifier: Apache-2.0
// Results of the first pass over a file with a skeleton and a fixed time between frames.
#pragma once

#include "kinalign/take/recording.h"

namespace kinalign {

/// `survey` follows from the time between frames, so the frames themselves are not read.
struct ClipSurvey {
  Skeleton skeleton;
  StampSurvey survey;
  double step_ns = 0.0;  // time from one frame to the next
  InputFacts facts;
  Findings findings;
};

}  // namespace kinalign
