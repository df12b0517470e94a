// SPDX-License-Identifier: Apache-2.0
// The person of built_in_motion.h: computes the rotation of each joint from the act and the time
// within the act.
#pragma once

#include "kinalign/motion/pose.h"
#include "kinalign/simulate/person/footsteps.h"
#include "kinalign/simulate/person/leg.h"
#include "kinalign/simulate/person/perception_neuron.h"
#include "kinalign/simulate/random.h"

#include <array>

namespace kinalign {

/// Sway, breath and glances: a sum of four sines with random phases; rms 1 over a long time.
class SlowNoise {
 public:
  /// The frequencies begin at `least_hz` and cover two and a half octaves.
  SlowNoise(const RandomStream& random, std::uint64_t number, double least_hz);
  double at(double t) const;

 private:
  std::array<double, 4> rate_{}, phase_{};  // rad/s, rad
};

/// How far each slow movement of one arm is carried out; 1 is a movement of amplitude 1.
struct ArmDoing {
  double front = 0.0, side = 0.0;  // raised to the front; raised to the side
  /// guard: the hand is before the chest; reach: the hand is pushed away from the chest
  double guard = 0.0, reach = 0.0;
};

/// How far each movement is carried out at a moment. doing_at() computes it from the act; the put_
/// functions convert it to rotations.
struct Doing {
  double down = 1.0;  // 1: arms hang down; 0: T-pose
  double wave = 0.0, wave_phase = 0.0;
  double bend = 0.0, squat = 0.0;                    // 1: a movement of amplitude 1
  double gait = 0.0, gait_phase = 0.0, reach = 0.0;  // reach: 1 when walking at 0.8 m/s
  double side = 1.0;                                 // side of the waving hand
  double lean = 0.0, twist = 0.0;                    // of the trunk; positive to the left
  ArmDoing left, right;
};

/// A person with a programme. All random numbers are drawn in the constructor, and `pose_at` only
/// computes.
class BuiltInBody {
 public:
  /// `person` determines proportions and personal style. `seed` determines everything that differs
  /// between two performances.
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
  double hang_, elbow_;  // rad: how far the upper arms hang down and the elbows are bent
};

}  // namespace kinalign
