// SPDX-License-Identifier: Apache-2.0
// The input of a model that fuses a Kinect and nodes of one recording: both on one grid, nodes on
// their bones, one heading.
#pragma once

#include "apps/kinalign/learn/point_source.h"
#include "apps/kinalign/learn/worn_nodes.h"

#include "kinalign/models/fuse/fuse_model.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

/// Both devices as their files state them.
struct BothDevices {
  NamedPoints kinect;
  NamedNodes nodes;
};

/// The input of a network, and its sources.
/// Both devices have the same grid of T frames. Orientations of nodes and positions of the Kinect
/// are in one world with one heading.
struct FusedInput {
  FuseInput input;
  Time start{};
  std::string kinect;  // the name of its stream
  NamedNodes nodes;    // names only, no tracks
  PosedNodes posed;
  Skeleton body;         // the model's, as long as the Kinect sees the person
  bool is_sized = true;  // false: the Kinect saw too little of the legs, so `body` has the model's
                         // size
  std::vector<std::string> warnings{};  // about the Kinect's stream
};

/// Fails if the Kinect has fewer than two frames, if nodes do not fit, or if both devices never see
/// the person together for a second. Errors may have no file's name.
Result<FusedInput> fused_input(const FuseModel& model, BothDevices both, const WornWords& worn);

/// The JSON about the input: the members of about_nodes() and those of both streams.
nlohmann::ordered_json about_fused(const FuseModel& model, const FusedInput& given);

}  // namespace kinalign
