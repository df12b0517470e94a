// SPDX-License-Identifier: Apache-2.0
// The person of built_in_motion.h: what each joint does, by the act and the time within it.
#pragma once

#include "kinalign/motion/pose.h"
#include "kinalign/simulate/person/footsteps.h"
#include "kinalign/simulate/person/leg.h"
#include "kinalign/simulate/person/perception_neuron.h"
#include "kinalign/simulate/random.h"

#include <array>

namespace kinalign {

/// Sway, breath and glances: four sines of drawn phase, rms 1 over a long time.
class SlowNoise {
 public:
  /// Rates from `least_hz` on, over two octaves and a half.
  SlowNoise(const RandomStream& random, std::uint64_t number, double least_hz);
  double at(double t) const;

 private:
  std::array<double, 4> rate_{}, phase_{};  // rad/s, rad
};

/// The share of each slow movement in one arm's pose; 1: as far as an amplitude of 1 goes.
struct ArmDoing {
  double front = 0.0, side = 0.0;   // raised
  double guard = 0.0, reach = 0.0;  // the hand before the chest; pushed away from there
};

/// How much of each movement there is at a moment.
struct Doing {
  double down = 1.0;  // the arms; 0 in T-pose
  double wave = 0.0, wave_phase = 0.0;
  double bend = 0.0, squat = 0.0;                    // 1: as far as an amplitude of 1 goes
  double gait = 0.0, gait_phase = 0.0, reach = 0.0;  // reach: 1 where one walks at 0.8 m/s
  double side = 1.0;                                 // of the waving hand
  double lean = 0.0, twist = 0.0;                    // of the trunk; above 0 to the left
  ArmDoing left, right;
};

class BuiltInBody {
 public:
  /// `person`: whose proportions and habits; `seed`: of all that differs from time to time.
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
  double hang_, elbow_;  // rad: how far the upper arms hang down, how far elbows are bent
};

}  // namespace kinalign
