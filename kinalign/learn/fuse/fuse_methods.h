// SPDX-License-Identifier: Apache-2.0
// Methods that fuse a Kinect and nodes, one file for each.
#pragma once

#include "kinalign/learn/fuse/fuse_task.h"

#include <string_view>
#include <vector>

namespace kinalign {

/// A method is a network, its data and its training. FuseTask and train() serve all of them.
struct FuseMethod {
  std::string_view name, summary, source;
  /// The network from the layout's channels to its outputs.
  Architecture (*architecture)(const FuseLayout& layout);
  FuseTraining training;
  TrainingOptions options;
};

FuseMethod gated_method();
FuseMethod gated_online_method();
/// The network of the HFUT-MMD paper, for both devices, the Kinect alone, or the nodes alone.
FuseMethod bilstm_method(Devices devices);

std::vector<FuseMethod> fuse_methods();

}  // namespace kinalign
