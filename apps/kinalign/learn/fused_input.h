// SPDX-License-Identifier: Apache-2.0
// Prepares a Kinect and nodes of one recording for a model that fuses them: common frames, nodes
// calibrated on their bones, and the same heading.
#pragma once

#include "apps/kinalign/learn/point_source.h"
#include "apps/kinalign/learn/worn_nodes.h"

#include "kinalign/models/fuse/fuse_model.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

/// A Kinect and nodes, as they were read from files.
struct BothDevices {
  NamedPoints kinect;
  NamedNodes nodes;
};

/// The input of a model for fusion, and where it comes from. Both devices have the same frames, and
/// coordinates with the same heading.
struct FusedInput {
  FuseInput input;
  Time start{};
  std::string kinect;  // the name of the Kinect's stream
  NamedNodes nodes;    // names only; the tracks are empty
  PosedNodes posed;
  Skeleton body;  // the model's body, scaled to the legs that the Kinect sees
  // False if the Kinect saw too little of the legs; `body` then has the model's size.
  bool is_sized = true;
  std::vector<std::string> warnings{};  // about the Kinect's stream
};

/// Fails if the Kinect has fewer than two frames, if the model's nodes are missing, or if both
/// devices never see the person for the same second. Some errors name no file.
Result<FusedInput> fused_input(const FuseModel& model, BothDevices both, const WornWords& worn);

/// The JSON about the input: the members of about_nodes(), and members about both streams.
nlohmann::ordered_json about_fused(const FuseModel& model, const FusedInput& given);

}  // namespace kinalign
