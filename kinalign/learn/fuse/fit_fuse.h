// SPDX-License-Identifier: Apache-2.0
// Trains a model that fuses a Kinect and nodes, from sequences and a method.
#pragma once

#include "kinalign/learn/fit_denoise.h"
#include "kinalign/learn/fuse/fuse_methods.h"
#include "kinalign/learn/pose/fit_pose.h"

namespace kinalign {

struct FuseFit {
  FuseModel model;  // in `facts` only task and method are set
  std::vector<TrainingPoint> points;
};

/// The layout for the nodes of `data` and all joints of the Kinect that fusion uses.
FuseLayout fuse_layout(const FuseData& data);

/// `from`: a model of the same method to continue from.
Result<FuseFit> fit_fuse(const FuseMethod& method, const FuseData& data, const FitOptions& options,
                         TrainingState state, const TrainingHooks& hooks,
                         const FuseModel* from = nullptr);

}  // namespace kinalign
