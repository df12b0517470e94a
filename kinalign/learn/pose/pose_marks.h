// SPDX-License-Identifier: Apache-2.0
// Measures a model on people who were not in the training, with nodes of decreasing quality. The
// errors are the same for every model.
#pragma once

#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/models/pose/pose_metrics.h"
#include "kinalign/models/pose/pose_model.h"

#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The errors of one model with its nodes in one state.
struct PoseMark {
  /// State of the nodes: "clean", "calibrated", "20 minutes later", "wrist_left lost".
  std::string nodes;
  PoseErrors answer;                           // of the network's output
  PoseErrors smoothed;                         // the result of PoseSolver::solve()
  std::map<std::string, PoseErrors> people{};  // smoothed, by person
};

/// One result for each state of the nodes, over data.tested. `lost`: the leaf that is lost in the
/// last result. Fails if the model's nodes or bones are not those of the data, or if there is no
/// test person.
Result<std::vector<PoseMark>> pose_marks(PoseSolver& solver, const PoseData& data,
                                         std::size_t lost);

}  // namespace kinalign
