// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fuse/fit_fuse.h"

#include <utility>

namespace kinalign {

FuseLayout fuse_layout(const FuseData& data) {
  return {{data.pose.nodes, data.pose.body.bones, PoseInputs::ours, data.pose.rate_hz},
          fuse_joint_names()};
}

Result<FuseFit> fit_fuse(const FuseMethod& method, const FuseData& data, const FitOptions& options,
                         TrainingState state, const TrainingHooks& hooks, const FuseModel* from) {
  const FuseLayout layout = fuse_layout(data);
  KA_TRY(validate(layout));
  FuseTask task(layout, method.training, data, options.device);
  // The generator is seeded after the task is made. The task draws from its own streams, so the
  // first weights depend on the seed alone.
  torch::manual_seed(options.training.seed);
  TorchNetwork network(method.architecture(layout));
  if (from != nullptr) KA_TRY(go_on_from(*from, task, network));
  network.to(options.device);
  FuseFit out;
  out.points = KA_TRY(train(network, task, options.training, std::move(state), hooks)).points;
  out.model.facts.task = "fuse";
  out.model.facts.method = method.name;
  out.model.layout = layout;
  put_learnt(task, network, data.pose.body, out.model);
  return out;
}

}  // namespace kinalign
