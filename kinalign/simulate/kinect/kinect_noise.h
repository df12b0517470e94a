// SPDX-License-Identifier: Apache-2.0
// Size of the error of each joint of a Kinect v2. The figures were measured on UI-PRMD against
// Vicon (620 repetitions of seven people) and on the two-Kinect recordings of KinectMultiTrack.
// Some figures were changed so that the model's statistics equal the measured ones;
// docs/kinect_noise_fit.md explains each change.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/simulate/kinect/kinect_body.h"

#include <array>

namespace kinalign {

/// Error of one joint. The axes are those of the body's heading: x to the person's left, y up, z to
/// the person's front. The errors of a joint are added: offset, slow error of the pose, slow error
/// of time, white noise and twitches.
struct KinectJointNoise {
  KinectJoint source;   // the draws are correlated with those of this joint
  double kinship;       // correlation with `source`
  Vec3 offset;          // m, common to all people; x is for a left or middle joint
  double person;        // m, standard deviation (sd) between people, norm of three axes
  double take;          // m, sd between takes of one person, norm of three axes
  Vec3 within;          // m, sd within a take, for each axis
  double spread;        // sd of the logarithm of a take's error size
  double tau;           // s, time constant of the moving part of the slow error
  double white;         // m, for each axis, at rest
  double white_speed;   // m, added at a speed of 1 m/s
  double white_stir;    // m, added if the pose changes by 1 m/s
  double tail;          // degrees of freedom of the Student's t distribution of white noise
  double twitch = 1.0;  // frequency of twitches, relative to the usual frequency
};

/// [25] in the order of JointType.
const std::array<KinectJointNoise, kinect_joint_count>& kinect_joint_noise();

}  // namespace kinalign
