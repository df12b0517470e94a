// SPDX-License-Identifier: Apache-2.0
// Stores a training run in a file, from which it can be continued with the same result.
#pragma once

#include "kinalign/learn/trainer.h"

#include <string>
#include <string_view>

namespace kinalign {

/// A SafeTensors file of all tensors. `job` describes what is trained; a continued run must have
/// the same job. A run that continues from the file gives the same bytes as a run without a stop
/// (docs/training.md). So the file also has both moments of Adam, the average of the weights and
/// all points of the log.
std::string write_checkpoint(const TrainingState& state, const std::string& job);

/// Fails if the file is not a checkpoint or belongs to another job.
Result<TrainingState> read_checkpoint(std::string_view bytes, const std::string& job,
                                      const std::string& name);

/// CSV lines "step,loss,rate,gradient,judgement" with a header line.
std::string csv_of(const std::vector<TrainingPoint>& points);

/// The points as an event file for TensorBoard. Wall times are 0, so the same run gives the same
/// bytes.
std::string events_of(const std::vector<TrainingPoint>& points);

}  // namespace kinalign
