// SPDX-License-Identifier: Apache-2.0
// A training run kept in a file, from which it goes on with the same result.
#pragma once

#include "kinalign/learn/trainer.h"

#include <string>
#include <string_view>

namespace kinalign {

/// SafeTensors of all tensors; `job` says what is trained, and must be the same to go on.
std::string write_checkpoint(const TrainingState& state, const std::string& job);

/// Fails where the file is no checkpoint, or of another job.
Result<TrainingState> read_checkpoint(std::string_view bytes, const std::string& job,
                                      const std::string& name);

/// Lines "step,loss,rate,gradient,judgement" with a head.
std::string csv_of(const std::vector<TrainingPoint>& points);

/// The points as a file of events that TensorBoard shows. Times are 0, so that the same run gives
/// the same bytes.
std::string events_of(const std::vector<TrainingPoint>& points);

}  // namespace kinalign
