// SPDX-License-Identifier: Apache-2.0
// A Kinect and nodes of one recording as a model that fuses them is given both: one grid, nodes on
// their bones, one heading.
#pragma once

#include "apps/kinalign/learn/point_source.h"
#include "apps/kinalign/learn/worn_nodes.h"

#include "kinalign/models/fuse/fuse_model.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

/// Both devices as they came.
struct BothDevices {
  NamedPoints kinect;
  NamedNodes nodes;
};

/// What a network is given, and where it comes from.
struct FusedInput {
  FuseInput input;
  Time start{};
  std::string kinect;  // its stream
  NamedNodes nodes;    // names alone
  PosedNodes posed;
  Skeleton body;                        // the model's, as long as the Kinect sees the person
  bool is_sized = true;                 // else the Kinect saw too little, and `body` is the model's
  std::vector<std::string> warnings{};  // of the Kinect
};

/// Fails where the Kinect has fewer than two frames, nodes do not fit, or both devices are never
/// seen together for a second. Errors may have no file's name.
Result<FusedInput> fused_input(const FuseModel& model, BothDevices both, const WornWords& worn);

/// What there is to be said of it: the members of about_nodes() and of both streams.
nlohmann::ordered_json about_fused(const FuseModel& model, const FusedInput& given);

}  // namespace kinalign
