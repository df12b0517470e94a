// SPDX-License-Identifier: Apache-2.0
// Methods that fuse, a file each.
#pragma once

#include "kinalign/learn/fuse/fuse_task.h"

#include <string_view>
#include <vector>

namespace kinalign {

struct FuseMethod {
  std::string_view name, summary, source;
  /// From the layout's channels to its answers.
  Architecture (*architecture)(const FuseLayout& layout);
  FuseTraining training;
  TrainingOptions options;
};

FuseMethod gated_method();
FuseMethod gated_online_method();
/// The paper's, for both devices, the Kinect alone, the nodes alone.
FuseMethod bilstm_method(Devices devices);

std::vector<FuseMethod> fuse_methods();

}  // namespace kinalign
