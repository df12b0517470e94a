// SPDX-License-Identifier: Apache-2.0
// The person of built_in_motion.h: the rotation of each joint, by the act and the time within it.
#pragma once

#include "kinalign/motion/pose.h"
#include "kinalign/simulate/person/footsteps.h"
#include "kinalign/simulate/person/leg.h"
#include "kinalign/simulate/person/perception_neuron.h"
#include "kinalign/simulate/random.h"

#include <array>

namespace kinalign {

/// Sway, breath and glances: four sines of random phase, rms 1 over a long time.
class SlowNoise {
 public:
  /// Frequencies start at `least_hz` and span two and a half octaves.
  SlowNoise(const RandomStream& random, std::uint64_t number, double least_hz);
  double at(double t) const;

 private:
  std::array<double, 4> rate_{}, phase_{};  // rad/s, rad
};

/// Amount of each slow movement in the pose of one arm; 1 corresponds to an amplitude of 1.
struct ArmDoing {
  double front = 0.0, side = 0.0;  // raised to the front; raised to the side
  /// Guard: the hand is before the chest; reach: it is pushed away from there.
  double guard = 0.0, reach = 0.0;
};

/// Amount of each movement at a moment.
/// It is computed from the act and turned into rotations by the put_ functions.
struct Doing {
  double down = 1.0;  // arms hang down; 0 in T-pose
  double wave = 0.0, wave_phase = 0.0;
  double bend = 0.0, squat = 0.0;                    // 1 corresponds to an amplitude of 1
  double gait = 0.0, gait_phase = 0.0, reach = 0.0;  // reach: 1 for walking at 0.8 m/s
  double side = 1.0;                                 // side of the waving hand
  double lean = 0.0, twist = 0.0;                    // movements of the trunk; positive to the left
  ArmDoing left, right;
};

/// A person with a programme: everything random is drawn when it is made, and `pose_at` only
/// computes.
class BuiltInBody {
 public:
  /// `person` determines proportions and personal style; `seed` everything that differs from time
  /// to time.
  BuiltInBody(double height_m, std::uint64_t person, std::uint64_t seed, std::vector<Act> acts);

  void pose_at(double t, Pose& pose) const;
  const Skeleton& skeleton() const { return skeleton_; }
  const FootTrack& left_foot() const { return left_; }
  const FootTrack& right_foot() const { return right_; }
  double length_s() const { return acts_.back().end_s; }

 private:
  struct Pelvis {
    Vec3 position;
    Quat rotation;
    double yaw = 0.0;
  };
  Doing doing_at(double t) const;
  Pelvis pelvis_at(double t, const Doing& doing, const FootState& left,
                   const FootState& right) const;
  double hip_height(const Pelvis& level, const FootState& left, const FootState& right,
                    double width) const;
  void put_leg(const Pelvis& pelvis, const FootState& foot, NeuronJoint up_leg, Pose& pose) const;
  void put_trunk(double t, const Doing& doing, Pose& pose) const;
  void put_arm(double t, const Doing& doing, double side, Pose& pose) const;
  void put_fingers(double curl, double side, Pose& pose) const;

  Skeleton skeleton_;
  double scale_;  // 1: a person of 1.75 m
  std::vector<Act> acts_;
  BodyPath path_;
  LegBones bones_;
  FootTrack left_, right_;
  SlowNoise sway_x_, sway_z_, breath_, glance_, nod_, lean_;
  double hang_, elbow_;  // rad: how far the upper arms hang down, and how far the elbows are bent
};

}  // namespace kinalign
