// SPDX-License-Identifier: Apache-2.0
// Size of the error of each joint of a Kinect v2. The figures were measured on UI-PRMD against
// Vicon (620 repetitions of seven people) and on the two-Kinect recordings of KinectMultiTrack.
// docs/kinect_noise_fit.md explains each figure that was changed so that the model's statistics
// equal the measured ones.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/simulate/kinect/kinect_body.h"

#include <array>

namespace kinalign {

/// Error of one joint. Heading space: x to the person's left, y up, z in the direction that the
/// body faces.
/// The errors of a joint add up: offset, slow error of the pose, slow error of time, white noise,
/// twitches.
struct KinectJointNoise {
  KinectJoint source;   // draws are correlated with those of this joint
  double kinship;       // correlation with the source
  Vec3 offset;          // m, common to all people; x is that of a left joint or one in the middle
  double person;        // m, sd of the offset between people, norm of three axes
  double take;          // m, sd between takes of one person, norm of three axes
  Vec3 within;          // m, sd within a take, for each axis
  double spread;        // sd of the log of a take's errors: how much takes differ
  double tau;           // s, time constant of the moving part of the slow error
  double white;         // m, for each axis, at rest
  double white_speed;   // m, added at a speed of 1 m/s
  double white_stir;    // m, added if the pose changes by 1 m/s
  double tail;          // degrees of freedom of Student's t, from which white noise is drawn
  double twitch = 1.0;  // frequency of twitches, relative to the usual
};

/// [25] in JointType order.
const std::array<KinectJointNoise, kinect_joint_count>& kinect_joint_noise();

}  // namespace kinalign
