// SPDX-License-Identifier: Apache-2.0
// Trains a model of poses, from sequences and a method.
#pragma once

#include "kinalign/learn/fit_denoise.h"
#include "kinalign/learn/pose/pose_methods.h"
#include "kinalign/models/pose/pose_model.h"

namespace kinalign {

/// The caller adds the facts about data and metrics before it writes the model.
struct PoseFit {
  PoseModel model;  // in `facts` only task and method are set
  std::vector<TrainingPoint> points;
};

/// `from`: a model of the same method to continue from.
Result<PoseFit> fit_pose(const PoseMethod& method, const PoseData& data, const FitOptions& options,
                         TrainingState state, const TrainingHooks& hooks,
                         const PoseModel* from = nullptr);

/// Starts from the weights and the scales of `from`.
template <class Task>
Result<void> go_on_from(const BodyModel& from, Task& task, TorchNetwork& network) {
  task.use_scales(from.input_mean, from.input_scale);
  return take_tensors(from.tensors, "net.", network);
}

/// Copies the learnt weights and scales into a model. `body`: the mean body of the training people,
/// which the model's poses have (PoseBody).
template <class Task>
void put_learnt(const Task& task, const TorchNetwork& network, const PoseBody& body,
                BodyModel& out) {
  out.body = body;
  out.input_mean = task.input_mean();
  out.input_scale = task.input_scale();
  out.architecture = network.architecture();
  put_tensors(network, "net.", out.tensors);
}

}  // namespace kinalign
