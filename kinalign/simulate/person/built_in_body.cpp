// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 104 of a seed gives frequencies and phases of sway, breath and
// glances, by their number. Lanes 0 to 2 of number 10 give the person's style of holding feet and
// arms. These sizes are estimates: sway (5 mm), breath (half a degree for each segment), and the
// movement of pelvis and trunk in walking (4 degrees).
#include "kinalign/simulate/person/built_in_body.h"

#include "kinalign/motion/rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

using std::numbers::pi;
// Longest distance between hip and ankle, as a share of the length of the leg's bones.
constexpr double longest_leg = 0.9985;
constexpr double bend_depth = 0.75;   // rad, of the pelvis
constexpr double squat_depth = 0.30;  // m
constexpr double deep = 1.3;          // depth of a deep squat relative to a usual squat

Quat about_x(double angle) { return rotation(Vec3(angle, 0, 0)); }
Quat about_y(double angle) { return rotation(Vec3(0, angle, 0)); }
Quat about_z(double angle) { return rotation(Vec3(0, 0, angle)); }

/// Returns the size of the repeated movement at t. All repetitions of an act have the same length,
/// and as many as possible fit into the act.
double repeated(const Act& act, double t) {
  const double room = act.end_s - act.begin_s;
  const auto times = std::max(1.0, std::floor(room / act.tempo_s));
  const double each = room / times;
  const double x = (t - act.begin_s) / each;
  return act.amplitude * bump(x - std::clamp(std::floor(x), 0.0, times - 1.0));
}

/// Gives both arms the same movement.
void do_with_both(Doing& doing, const ArmDoing& arm) { doing.left = doing.right = arm; }

/// Returns a push: the hand moves to the chest, away from the chest, back, and down.
ArmDoing push_of(const Repetition& one, double t) {
  const double x = one.share(t);
  ArmDoing arm;
  arm.guard = rise(x / 0.3) * rise((1.0 - x) / 0.3);
  arm.reach = one.amplitude * rise((x - 0.22) / 0.3) * rise((0.84 - x) / 0.3);
  return arm;
}

/// Adds the movement of a slow act. The curves are estimates. Tests check that each movement stays
/// within the range of people.
void do_slowly(const Act& act, double t, Doing& doing) {
  const Repetition& one = repetition_at(act.repetitions, t);
  const double size = one.size(t);
  ArmDoing& near = one.side > 0.0 ? doing.left : doing.right;
  ArmDoing& far = one.side > 0.0 ? doing.right : doing.left;
  switch (act.piece) {
    case Piece::raise_front:
      do_with_both(doing, {.front = size});
      break;
    case Piece::raise_side:
      do_with_both(doing, {.side = size});
      break;
    case Piece::push:
      near = push_of(one, t);
      break;
    case Piece::push_both:
      do_with_both(doing, push_of(one, t));
      break;
    case Piece::bend_side:
      doing.lean = one.side * size;
      far.side = size;
      break;
    case Piece::twist:
      doing.twist = one.side * size;
      break;
    case Piece::deep_squat:
      doing.squat = deep * size;
      break;
    default:
      break;
  }
}

// Takes the measures from the toes' end site in the skeleton. The feet are as far apart as the
// hips.
FootShape foot_shape(const Skeleton& skeleton, const RandomStream& random) {
  const Vec3& toes = skeleton.end_sites.front().offset;
  return {-toes.y(), toes.z(), skeleton.rest_offsets[index(NeuronJoint::left_up_leg)].x(),
          0.05 + 0.08 * random.uniform(10, 0)};
}

}  // namespace

SlowNoise::SlowNoise(const RandomStream& random, std::uint64_t number, double least_hz) {
  for (std::uint64_t i = 0; i < rate_.size(); ++i) {
    const double octaves = 0.8 * (static_cast<double>(i) + 0.4 * random.uniform(number, 2 * i));
    rate_[i] = 2.0 * pi * least_hz * std::exp2(octaves);
    phase_[i] = 2.0 * pi * random.uniform(number, 2 * i + 1);
  }
}

// The mean square of the sum of four sines is 2. The factor makes the rms 1.
double SlowNoise::at(double t) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < rate_.size(); ++i) sum += std::sin(rate_[i] * t + phase_[i]);
  return std::numbers::sqrt2 / 2.0 * sum;
}

// All random numbers about the person come from `person`, all others from `seed`.
BuiltInBody::BuiltInBody(double height_m, std::uint64_t person, std::uint64_t seed,
                         std::vector<Act> acts)
    : skeleton_(perception_neuron(height_m, person)),
      scale_(height_m / 1.75),
      acts_(std::move(acts)),
      path_(acts_, seed, scale_),
      bones_{skeleton_.rest_offsets[index(NeuronJoint::left_leg)].norm(),
             skeleton_.rest_offsets[index(NeuronJoint::left_foot)].norm()},
      left_(acts_, path_, foot_shape(skeleton_, RandomStream(person, 104)), 1.0, scale_),
      right_(acts_, path_, foot_shape(skeleton_, RandomStream(person, 104)), -1.0, scale_),
      sway_x_(RandomStream(seed, 104), 0, 0.07),
      sway_z_(RandomStream(seed, 104), 1, 0.07),
      breath_(RandomStream(seed, 104), 2, 0.2),
      glance_(RandomStream(seed, 104), 3, 0.05),
      nod_(RandomStream(seed, 104), 4, 0.06),
      lean_(RandomStream(seed, 104), 5, 0.05),
      hang_(1.32 + 0.1 * RandomStream(person, 104).uniform(10, 1)),
      elbow_(0.2 + 0.15 * RandomStream(person, 104).uniform(10, 2)) {}

/// Returns how far each movement is carried out at t. Movements fade out at the ends of an act, so
/// there is no jump between acts.
Doing BuiltInBody::doing_at(double t) const {
  const Act& act = act_at(acts_, t);
  Doing doing;
  doing.side = act.side;
  switch (act.piece) {
    case Piece::t_pose:
      doing.down = 1.0 - act.within(t, 1.3);
      break;
    case Piece::wave:
      doing.wave = act.amplitude * act.within(t, 1.4);
      doing.wave_phase = 2.0 * pi * (t - act.begin_s) / act.tempo_s;
      break;
    case Piece::bend:
      doing.bend = repeated(act, t);
      break;
    case Piece::squat:
      doing.squat = repeated(act, t);
      break;
    case Piece::step:
    case Piece::walk:
    case Piece::walk_turn:
    case Piece::turn: {
      const StepTimes steps = step_times(act);
      if (steps.count == 0) break;
      const double end = steps.lands(steps.count - 1);
      doing.gait = rise((t - act.begin_s) / 1.0) * rise((end - t) / 1.0);
      // At phase 0 the left foot leaves the floor. If the right foot is first, the phase is shifted
      // by half a cycle.
      doing.gait_phase =
          2.0 * pi * (t - steps.first_s) / steps.stride_s + (act.side > 0 ? 0.0 : pi);
      const bool walks = act.piece == Piece::walk || act.piece == Piece::walk_turn;
      doing.reach = walks ? act.speed / 0.8 : 0.25;
      break;
    }
    case Piece::stand:
      break;
    default:
      do_slowly(act, t, doing);
      break;
  }
  return doing;
}

/// Returns the height of the pelvis at which the more stretched leg has its greatest length: the
/// lower of the heights for the two legs. A smooth minimum keeps the motion differentiable.
double BuiltInBody::hip_height(const Pelvis& level, const FootState& left, const FootState& right,
                               double width) const {
  const double reach = longest_leg * (bones_.thigh + bones_.shank);
  // The height above one foot. If the feet are too far apart, the height is half of the leg's
  // length.
  const auto allowed = [&](NeuronJoint up_leg, const FootState& foot) {
    const Vec3 hip = level.rotation * skeleton_.rest_offsets[index(up_leg)];
    const double x = level.position.x() + hip.x() - foot.ankle.x();
    const double z = level.position.z() + hip.z() - foot.ankle.z();
    const double square = std::max(reach * reach - x * x - z * z, 0.25 * reach * reach);
    return foot.ankle.y() - hip.y() + std::sqrt(square);
  };
  return soft_min(allowed(NeuronJoint::left_up_leg, left),
                  allowed(NeuronJoint::right_up_leg, right), width);
}

/// Computes position and rotation of the pelvis from the path, the steps and the act.
BuiltInBody::Pelvis BuiltInBody::pelvis_at(double t, const Doing& doing, const FootState& left,
                                           const FootState& right) const {
  const FloorPlace body = path_.at(t);
  // The left foot is in the air for phases from 0 to 0.8 pi. During this time the body is above the
  // right foot. When the left foot lands, the left hip is in front.
  const double over = std::cos(doing.gait_phase - 0.4 * pi);
  const double front = std::cos(doing.gait_phase - 0.85 * pi);
  Pelvis pelvis;
  pelvis.yaw =
      body.yaw - 0.08 * doing.gait * doing.reach * front + 0.01 * lean_.at(t) + 0.2 * doing.twist;
  const double pitch = bend_depth * doing.bend + 0.35 * doing.squat + 0.02 * doing.gait;
  pelvis.rotation = about_y(pelvis.yaw) * about_x(pitch) *
                    about_z(-0.05 * doing.gait * over + 0.006 * lean_.at(t) - 0.08 * doing.lean);
  const double aside =
      scale_ * (0.005 * sway_x_.at(t) - 0.022 * doing.gait * over - 0.05 * doing.lean);
  const double back = scale_ * (0.005 * sway_z_.at(t) - 0.11 * doing.bend - 0.13 * doing.squat);
  pelvis.position = Vec3(body.x, 0, body.z) + about_y(body.yaw) * Vec3(aside, 0, back);
  // In walking the smooth minimum is wider, so that the height changes smoothly from one leg to the
  // other.
  const double width = scale_ * (0.003 + 0.05 * doing.gait);
  pelvis.position.y() = hip_height(pelvis, left, right, width) - scale_ * squat_depth * doing.squat;
  return pelvis;
}

// The knee points in the direction between those of pelvis and foot. Three rotations put the ankle
// to its position and give the foot its own rotation.
void BuiltInBody::put_leg(const Pelvis& pelvis, const FootState& foot, NeuronJoint up_leg,
                          Pose& pose) const {
  const std::size_t up = index(up_leg);
  const Vec3 hip = pelvis.position + pelvis.rotation * skeleton_.rest_offsets[up];
  const Vec3 forward = about_y(0.5 * (pelvis.yaw + foot.yaw)) * Vec3::UnitZ();
  const BentLeg leg = reach(bones_, hip, foot.ankle, forward);
  pose.local_rotations[up] = pelvis.rotation.conjugate() * leg.thigh;
  pose.local_rotations[up + 1] = about_x(leg.knee);
  pose.local_rotations[up + 2] = leg.shank.conjugate() * foot.rotation;
}

// The four segments of the spine share each movement. Breath bends the upper two segments relative
// to the lower two.
void BuiltInBody::put_trunk(double t, const Doing& doing, Pose& pose) const {
  const double front = doing.gait * doing.reach * std::cos(doing.gait_phase - 0.85 * pi);
  const double over = doing.gait * std::cos(doing.gait_phase - 0.4 * pi);
  const double pitch = 0.13 * doing.bend + 0.06 * doing.squat;
  const double breath = 0.004 * breath_.at(t);
  for (const auto joint :
       {NeuronJoint::spine, NeuronJoint::spine1, NeuronJoint::spine2, NeuronJoint::spine3}) {
    const double chest = joint == NeuronJoint::spine2 || joint == NeuronJoint::spine3 ? -2.0 : 1.0;
    pose.local_rotations[index(joint)] =
        about_y(0.04 * front + 0.006 * lean_.at(t) + 0.15 * doing.twist) *
        about_x(pitch + chest * breath + 0.004 * nod_.at(t)) *
        about_z(0.012 * over - 0.11 * doing.lean);
  }
  // The head compensates a part of the trunk's bend, so that the person looks ahead.
  const double bent = bend_depth * doing.bend + 0.35 * doing.squat + 4.0 * pitch;
  const double free = 1.0 - 0.7 * (1.0 - doing.down);  // in T-pose the person looks ahead
  for (const auto joint : {NeuronJoint::neck, NeuronJoint::head}) {
    pose.local_rotations[index(joint)] =
        about_y(0.07 * free * glance_.at(t + 3.0) - 0.04 * front + 0.25 * doing.twist) *
        about_x(-0.2 * bent + 0.03 * free * nod_.at(t)) *
        about_z(0.015 * glance_.at(t) - 0.06 * doing.lean);
  }
}

/// Computes the rotations of one arm's joints. `side` is +1 for the left arm.
void BuiltInBody::put_arm(double t, const Doing& doing, double side, Pose& pose) const {
  const std::size_t shoulder =
      index(side > 0 ? NeuronJoint::left_shoulder : NeuronJoint::right_shoulder);
  const double wave = doing.side == side ? doing.wave : 0.0;
  const ArmDoing& arm = side > 0 ? doing.left : doing.right;
  const double front = doing.gait * std::cos(doing.gait_phase - 0.85 * pi);
  const double bent = bend_depth * doing.bend + 4.0 * 0.13 * doing.bend;
  const double slow = side * sway_x_.at(t + 7.0 * side) + breath_.at(t);
  // An arm swings backwards (+) while the leg of the same side moves forwards. If the trunk is
  // bent, the arm rotates forwards so that it hangs down.
  const double swing =
      doing.down * (side * (0.08 + 0.27 * doing.reach) * front - 0.85 * bent - 1.1 * doing.squat +
                    0.01 * slow - 2.2 * arm.front - 0.4 * arm.guard - 0.95 * arm.reach);
  const double lowered =
      hang_ * doing.down * (1.0 - wave) - 0.2 * wave + 0.006 * slow - 2.35 * arm.side;
  const double forth = std::sin(doing.wave_phase);
  const double elbow = elbow_ * doing.down * (1.0 - wave) + wave * (1.35 + 0.42 * forth) +
                       0.15 * doing.gait * doing.reach * (1.0 - side * front) + 0.03 +
                       1.85 * arm.guard - 1.45 * arm.reach;
  // Turns the forearm, which is bent forwards, so that it points upwards.
  const double outward = -1.4 * wave;
  pose.local_rotations[shoulder] =
      about_z(side * (0.22 * wave + 0.003 * breath_.at(t) + 0.3 * arm.side + 0.2 * arm.front));
  pose.local_rotations[shoulder + 1] = about_x(swing) * about_z(-side * lowered) * about_x(outward);
  pose.local_rotations[shoulder + 2] = about_y(-side * elbow);
  pose.local_rotations[shoulder + 3] =
      about_y(0.2 * side * wave * std::sin(doing.wave_phase - 0.8)) *
      about_z(0.01 * slow + side * 0.8 * arm.reach);
  put_fingers(0.3 * doing.down * (1.0 - 0.8 * wave), side, pose);
}

// Each finger has three joints. Before each finger, but not before the thumb, there is a joint of
// the palm.
void BuiltInBody::put_fingers(double curl, double side, Pose& pose) const {
  const std::size_t thumb = index(side > 0 ? NeuronJoint::left_thumb1 : NeuronJoint::right_thumb1);
  for (std::size_t k = 0; k < 3; ++k) pose.local_rotations[thumb + k] = about_y(-side * 0.4 * curl);
  for (std::size_t finger = 0; finger < 4; ++finger) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double more = 1.0 + 0.1 * static_cast<double>(finger);
      pose.local_rotations[thumb + 4 + 4 * finger + k] = about_z(-side * more * curl);
    }
  }
}

// The feet are computed first, because the legs limit the height of the pelvis. The legs are then
// computed from feet and pelvis.
void BuiltInBody::pose_at(double t, Pose& pose) const {
  pose.local_positions = skeleton_.rest_offsets;
  pose.local_rotations.assign(neuron_joints, Quat::Identity());
  const Doing doing = doing_at(t);
  const FootState left = left_.at(t), right = right_.at(t);
  const Pelvis pelvis = pelvis_at(t, doing, left, right);
  pose.local_positions[0] = pelvis.position;
  pose.local_rotations[0] = pelvis.rotation;
  put_leg(pelvis, left, NeuronJoint::left_up_leg, pose);
  put_leg(pelvis, right, NeuronJoint::right_up_leg, pose);
  put_trunk(t, doing, pose);
  for (const double side : {-1.0, 1.0}) put_arm(t, doing, side, pose);
}

}  // namespace kinalign
