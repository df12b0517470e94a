// SPDX-License-Identifier: Apache-2.0
// Methods that answer with a pose, a file each.
#pragma once

#include "kinalign/learn/pose/pose_task.h"
#include "kinalign/learn/trainer.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace kinalign {

struct PoseMethod {
  std::string_view name, summary, source;
  PoseInputs inputs = PoseInputs::ours;
  /// From the layout's channels to its answers.
  Architecture (*architecture)(const PoseLayout& layout);
  PoseTraining training;
  TrainingOptions options;
  /// Sets the weights that training begins with, where they are not random ones; else nullptr. A
  /// method of 0 steps keeps them.
  void (*begin)(const PoseTask& task, std::uint64_t seed, TorchNetwork& network) = nullptr;
};

PoseMethod inertial_method();
PoseMethod inertial_online_method();
PoseMethod dip_method();
PoseMethod dip_512_method();
PoseMethod dip_robust_method();
PoseMethod wouda_method();

std::vector<PoseMethod> pose_methods();

}  // namespace kinalign
