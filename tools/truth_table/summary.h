// SPDX-License-Identifier: Apache-2.0
// What the tables of truth_table say, in five lines for a reader who is new to them.
#pragma once

#include "kinalign/simulate/rehearsal/judge_recording.h"

#include <string>
#include <vector>

namespace kinalign {

struct JudgedRecording {
  const TrueRecording& truth;
  std::vector<TimeJudgement> times;    // one per device and node
  std::vector<ValueJudgement> values;  // as judge_values gives them
};

/// Lines "simulated", "recorded", "time", "space" and "turning". A line whose devices are not in
/// the recording is left out.
std::string summary(const JudgedRecording& judged);

}  // namespace kinalign
