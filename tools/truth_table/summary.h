// SPDX-License-Identifier: Apache-2.0
// The contents of truth_table's tables in five lines, for a reader who does not know the tables.
#pragma once

#include "kinalign/simulate/rehearsal/judge_recording.h"

#include <string>
#include <vector>

namespace kinalign {

struct JudgedRecording {
  const TrueRecording& truth;
  std::vector<TimeJudgement> times;    // one per device and node
  std::vector<ValueJudgement> values;  // in the order in which judge_values gives them
};

/// Lines "simulated", "recorded", "time", "space" and "turning". A line whose devices are not in
/// the recording is left out.
std::string summary(const JudgedRecording& judged);

}  // namespace kinalign
