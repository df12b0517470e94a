// SPDX-License-Identifier: Apache-2.0
// How a model does on people it was not trained on, with nodes that are less and less good. The
// errors are the same for every model.
#pragma once

#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/models/pose/pose_metrics.h"
#include "kinalign/models/pose/pose_model.h"

#include <map>
#include <string>
#include <vector>

namespace kinalign {

struct PoseMark {
  std::string nodes;    // "clean", "calibrated", "20 minutes later", "wrist_left lost"
  PoseErrors answer;    // as the network says it
  PoseErrors smoothed;  // as PoseSolver::solve gives it
  std::map<std::string, PoseErrors> people{};  // smoothed, by person
};

/// A row for each state of the nodes, over data.tested. `lost`: the leaf that is lost in the last
/// row. Fails where the model's nodes or bones are not the data's, or nobody is there to be tested.
Result<std::vector<PoseMark>> pose_marks(PoseSolver& solver, const PoseData& data,
                                         std::size_t lost);

}  // namespace kinalign
