// SPDX-License-Identifier: Apache-2.0
// What the first pass over a skeleton's file of a fixed step found.
#pragma once

#include "kinalign/take/recording.h"

namespace kinalign {

struct ClipSurvey {
  Skeleton skeleton;
  StampSurvey survey;
  double step_ns = 0.0;
  InputFacts facts;
  Findings findings;
};

}  // namespace kinalign
