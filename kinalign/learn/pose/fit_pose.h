// SPDX-License-Identifier: Apache-2.0
// From sequences and a method to a model.
#pragma once

#include "kinalign/learn/fit_denoise.h"
#include "kinalign/learn/pose/pose_methods.h"
#include "kinalign/models/pose/pose_model.h"

namespace kinalign {

struct PoseFit {
  PoseModel model;  // without facts of its data
  std::vector<TrainingPoint> points;
};

Result<PoseFit> fit_pose(const PoseMethod& method, const PoseData& data, const FitOptions& options,
                         TrainingState state, const TrainingHooks& hooks,
                         const PoseModel* from = nullptr);

}  // namespace kinalign
