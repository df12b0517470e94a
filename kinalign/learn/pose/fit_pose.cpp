// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/fit_pose.h"

#include <utility>

namespace kinalign {

Result<PoseFit> fit_pose(const PoseMethod& method, const PoseData& data, const FitOptions& options,
                         TrainingState state, const TrainingHooks& hooks, const PoseModel* from) {
  const PoseLayout layout{data.nodes, data.body.bones, method.inputs, data.rate_hz};
  PoseTask task(layout, method.training, data, options.device);
  torch::manual_seed(options.training.seed);
  TorchNetwork network(method.architecture(layout));
  if (from != nullptr) KA_TRY(go_on_from(*from, task, network));
  network.to(options.device);
  PoseFit out;
  // This comes after the network is on its device, because the drawn batches are on the device,
  // too.
  if (method.begin != nullptr) method.begin(task, options.training.seed, network);
  out.points = KA_TRY(train(network, task, options.training, std::move(state), hooks)).points;
  // A method with 0 steps has no log. Its validation error is written to the log here.
  if (out.points.empty()) out.points.push_back({.judgement = task.judge(network)});
  out.model.facts.task = "pose";
  out.model.facts.method = method.name;
  out.model.layout = layout;
  put_learnt(task, network, data.body, out.model);
  return out;
}

}  // namespace kinalign
