// SPDX-License-Identifier: Apache-2.0
// From sequences and a method to a model that fuses.
#pragma once

#include "kinalign/learn/fit_denoise.h"
#include "kinalign/learn/fuse/fuse_methods.h"
#include "kinalign/learn/pose/fit_pose.h"

namespace kinalign {

struct FuseFit {
  FuseModel model;  // without facts of its data
  std::vector<TrainingPoint> points;
};

FuseLayout fuse_layout(const FuseData& data);

Result<FuseFit> fit_fuse(const FuseMethod& method, const FuseData& data, const FitOptions& options,
                         TrainingState state, const TrainingHooks& hooks,
                         const FuseModel* from = nullptr);

}  // namespace kinalign
