// SPDX-License-Identifier: Apache-2.0
// How far off each joint of a Kinect v2 is: figures measured on UI-PRMD against Vicon (620
// repetitions of seven people) and on the two-Kinect recordings of KinectMultiTrack. Where a figure
// had to move so that the model's statistics meet the measured ones, docs/kinect_noise.md says why.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/simulate/kinect/kinect_body.h"

#include <array>

namespace kinalign {

/// One joint. Heading space: x to the person's left, y up, z to where the body faces.
struct KinectJointNoise {
  KinectJoint source;   // draws go down a tree: from this joint …
  double kinship;       // … with this correlation
  Vec3 offset;          // m, of all people, x for a left joint or one in the middle
  double person;        // m, sd of the offset between people, norm of three axes
  double take;          // m, sd between takes of one person, likewise
  Vec3 within;          // m, sd inside a take, per axis
  double spread;        // of the log of that sd between takes: how much they differ
  double tau;           // s, of the fast coloured part
  double white;         // m, per axis, at rest …
  double white_speed;   // … what a speed of 1 m/s adds …
  double white_stir;    // … and a pose that changes by 1 m/s
  double tail;          // degrees of freedom of Student's t that the white part is drawn from
  double twitch = 1.0;  // how often it twitches, times the usual
};

/// [25] in JointType order.
const std::array<KinectJointNoise, kinect_joint_count>& kinect_joint_noise();

}  // namespace kinalign
