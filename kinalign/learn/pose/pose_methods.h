// SPDX-License-Identifier: Apache-2.0
// Methods that estimate a pose, one file for each.
#pragma once

#include "kinalign/learn/pose/pose_task.h"
#include "kinalign/learn/trainer.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace kinalign {

/// A method is a network, its channels, its data and its training. PoseTask and train() serve all.
struct PoseMethod {
  std::string_view name, summary, source;
  PoseInputs inputs = PoseInputs::ours;
  /// The network from the layout's channels to its outputs.
  Architecture (*architecture)(const PoseLayout& layout);
  PoseTraining training;
  TrainingOptions options;
  /// Sets the initial weights if they are not random; else nullptr. A method with 0 steps keeps
  /// these weights.
  void (*begin)(const PoseTask& task, std::uint64_t seed, TorchNetwork& network) = nullptr;
};

/// The block of the networks "inertial" and "gated": its input plus a convolution of that input
/// with five taps.
Layer residual_block(std::size_t width, std::size_t dilation, bool causal, double dropout);

PoseMethod inertial_method();
PoseMethod inertial_online_method();
PoseMethod dip_method();
PoseMethod dip_512_method();
PoseMethod dip_robust_method();
PoseMethod wouda_method();

std::vector<PoseMethod> pose_methods();

}  // namespace kinalign
