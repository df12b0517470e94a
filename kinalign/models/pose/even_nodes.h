// SPDX-License-Identifier: Apache-2.0
// Samples of nodes, each with its own stamps, on the even grid that a model of poses works on.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/models/even_grid.h"
#include "kinalign/models/pose/node_calibration.h"
#include "kinalign/wire/time.h"

#include <optional>
#include <vector>

namespace kinalign {

/// T samples of one node in its own space. No samples: the node is lost. An array may be empty:
/// complete() makes orientation and angular velocity of what there is.
struct NodeTrack {
  std::vector<Time> stamps;              // [T] rising
  std::vector<double> orientation;       // [T,4] world_from_node, world y up
  std::vector<double> acceleration;      // [T,3] m/s2
  std::vector<double> angular_velocity;  // [T,3] rad/s
  bool gravity = true;                   // stands in the acceleration: at rest 9.8 upwards
};

/// Fills what the device did not say: the orientation by MahonyFilter, with a heading of the node's
/// own; the angular velocity by the turn to the next sample. Fails without acceleration, with
/// neither orientation nor angular velocity, and where an orientation has to be made of
/// accelerations without gravity.
Result<void> complete(NodeTrack& track);

/// The acceleration at a time is the mean of samples so near to it.
inline constexpr double acceleration_within_s = 4.0 / 60.0;

/// Puts a complete node at place `node` of each frame of `out`, whose arrays have room for the
/// grid. What is not known there stays as it is.
void put_node(const NodeTrack& track, const EvenSpan& grid, double rate_hz, std::size_t node,
              WornFrames& out);

/// Room for frames in which every node is lost.
WornFrames lost_nodes(std::size_t frames, std::size_t nodes);

struct EvenNodes {
  WornFrames worn;  // frame t is at start + t / rate
  Time start{};
};

/// `tracks` [N], complete; the last one is the root's, whose first and last stamp bound the grid.
/// Between two samples at most 0.2 s apart a node is valid. Its orientation lies on the shorter arc
/// between both. Its acceleration is turned into the world, freed of gravity, and averaged with
/// weights that fall in a line to 0 within 67 ms: the second difference of positions that models
/// are trained on (pose_data.cpp) is the same mean. Its angular velocity is averaged likewise
/// within half a frame. Samples that lie farther apart than that are joined by a line. Fails where
/// the root has fewer than two samples or the grid has more than 10,000,000 frames. `span`: the
/// frames, in place of the root's.
Result<EvenNodes> even_nodes(const std::vector<NodeTrack>& tracks, double rate_hz,
                             std::optional<EvenSpan> span = std::nullopt);

}  // namespace kinalign
