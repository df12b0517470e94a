// SPDX-License-Identifier: Apache-2.0
// Random errors of calibrated nodes: those that remain after a T-pose, and the heading drift after
// the T-pose.
#pragma once

#include "kinalign/models/pose/pose_features.h"
#include "kinalign/simulate/random.h"

#include <cstddef>

namespace kinalign {

/// Each node's errors are constant over the frames of a crop, as they are over a recording; noise
/// is drawn for each sample. The defaults are the errors that remain after a calibration. A network
/// that is trained without such errors gets much worse with calibrated nodes.
struct NodeErrors {
  double mount_deg = 5.0;     // rotation of the node on its bone, about each axis, 1 sigma
  double tilt_deg = 1.5;      // error of the vertical, about x and z, 1 sigma
  double yaw_deg = 10.0;      // heading error, uniform within +- this
  double drift_deg = 0.0;     // heading drift since the calibration, 1 sigma
  double gravity_leak = 0.5;  // share of the gravity due to the tilt that stays in the acceleration
  double acceleration_noise = 0.15;  // m/s2, 1 sigma
  double angular_noise = 0.02;       // rad/s, 1 sigma
  double lost_share = 0.1;           // share of the leaves that have no sample at all
};

/// No errors.
NodeErrors no_node_errors();
/// The drift of a heading after some minutes, degrees, 1 sigma: a random walk of 3 degrees in the
/// first minute.
double drift_after(double minutes);

/// Adds errors to `nodes`. The last node, the root's, is never lost. The same stream gives the same
/// errors.
NodeFrames with_errors(NodeFrames nodes, const NodeErrors& errors, const RandomStream& random);

/// `nodes` without the samples of node `lost`.
/// Only the flags change, so a lost node's numbers stay in the arrays.
NodeFrames without_node(NodeFrames nodes, std::size_t lost);

}  // namespace kinalign
