// SPDX-License-Identifier: Apache-2.0
// Resamples nodes, each with its own stamps, to the even grid that a model of poses needs.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/models/even_grid.h"
#include "kinalign/models/pose/node_calibration.h"
#include "kinalign/wire/time.h"

#include <optional>
#include <vector>

namespace kinalign {

/// T samples of one node in its own space. Without samples the node is lost. Orientation or angular
/// velocity may be empty; complete() computes it from the other arrays.
struct NodeTrack {
  std::vector<Time> stamps;              // [T] rising
  std::vector<double> orientation;       // [T,4] world_from_node, world y up
  std::vector<double> acceleration;      // [T,3] m/s2
  std::vector<double> angular_velocity;  // [T,3] rad/s
  bool gravity = true;                   // the acceleration contains gravity: 9.8 upwards at rest
};

/// Computes what the device did not send. A missing orientation comes from MahonyFilter, with an
/// arbitrary heading. A missing angular velocity comes from the rotation to the next sample. Fails
/// without acceleration, with neither orientation nor angular velocity, and if an orientation would
/// have to be computed from accelerations without gravity.
Result<void> complete(NodeTrack& track);

/// An acceleration is the weighted mean of the samples within this distance in time.
inline constexpr double acceleration_within_s = 4.0 / 60.0;

/// Writes a complete node to place `node` of each frame of `out`, whose arrays have room for the
/// grid. Frames without samples nearby are not changed.
void put_node(const NodeTrack& track, const EvenSpan& grid, double rate_hz, std::size_t node,
              WornFrames& out);

/// Frames in which every node is lost.
WornFrames lost_nodes(std::size_t frames, std::size_t nodes);

/// Nodes as they are worn, on the grid; calibrate() and on_bones() bring them onto bones.
struct EvenNodes {
  WornFrames worn;  // frame t is at start + t / rate
  Time start{};
};

/// Resamples `tracks` [N], which must be complete. The last one is the root's; its first and last
/// stamp bound the grid unless `span` gives the frames.
///
/// A node is valid between two samples at most 0.2 s apart. Its orientation is interpolated on the
/// shorter arc. Its acceleration is rotated into the world, gravity is removed, and the result is
/// averaged with weights that fall linearly to 0 within 67 ms. Models are trained on second
/// differences of positions (pose_data.cpp), which are the same mean. Angular velocity is averaged
/// likewise within half a frame. If samples are farther apart than that, both are interpolated
/// linearly.
///
/// Fails if the root has fewer than two samples or the grid has more than 10,000,000 frames.
Result<EvenNodes> even_nodes(const std::vector<NodeTrack>& tracks, double rate_hz,
                             std::optional<EvenSpan> span = std::nullopt);

}  // namespace kinalign
