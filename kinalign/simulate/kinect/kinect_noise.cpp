// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_noise.h"

namespace kinalign {

namespace {

constexpr double cm = 1e-2, mm = 1e-3;

using Table = std::array<KinectJointNoise, kinect_joint_count>;

// Fitted for each joint: `white` to the second differences at different speeds, `twitch` to the
// autocorrelation at one frame, `spread` to the share of errors above 10 cm.
constexpr double slow_limbs = 0.33, quick_feet = 0.23;  // s
constexpr double usual_tail = 3.0, feet_tail = 1.5;

struct Bias {
  Vec3 offset;
  double person, take;
};

/// Returns a joint with the usual values; lengths are in cm.
KinectJointNoise joint(KinectJoint source, double kinship, const Bias& bias, const Vec3& within) {
  return {.source = source,
          .kinship = kinship,
          .offset = bias.offset * cm,
          .person = bias.person * cm,
          .take = bias.take * cm,
          .within = within * cm,
          .spread = 0.5,
          .tau = slow_limbs,
          .white = 0.1 * mm,
          .white_speed = 2.7 * mm,
          .white_stir = 0.0,
          .tail = usual_tail,
          .twitch = 0.5};
}

// Sets the sizes of the white noise: at rest, mm, and for each m/s of speed, mm.
KinectJointNoise with_white(KinectJointNoise noise, double rest_mm, double speed_mm) {
  noise.white = rest_mm * mm;
  noise.white_speed = speed_mm * mm;
  return noise;
}

// For feet and ankles: their errors change faster, have heavier tails and differ more between
// takes.
KinectJointNoise on_the_ground(KinectJointNoise noise) {
  noise.tau = quick_feet;
  noise.tail = feet_tail;
  noise.twitch = 10.0;
  noise.spread = 0.7;
  noise.white_stir = 0.7 * mm;  // a foot at rest trembles while the leg bends
  return with_white(noise, 0.2, 1.3);
}

/// Returns a joint of the hand. Hands were not measured against Vicon, so they have the wrist's
/// figures times `factor`.
KinectJointNoise of_hand(const KinectJointNoise& wrist, KinectJoint source, double factor) {
  KinectJointNoise noise = wrist;
  noise.source = source;
  noise.kinship = 0.9;  // an estimate: hands move with wrists
  noise.offset *= factor;
  noise.person *= factor;
  noise.take *= factor;
  noise.within *= factor;
  return noise;
}

// Offsets and sizes in cm. A joint is set before the joints that are correlated with it.
void put_trunk(Table& t) {
  t[spine_base] = joint(spine_base, 0.0, {{0.0, -1.9, -2.8}, 2.4, 2.8}, {1.2, 1.5, 1.4});
  t[spine_mid] = joint(spine_base, 0.6, {{0.0, -3.6, -4.1}, 1.8, 2.5}, {0.9, 1.2, 1.4});
  t[spine_shoulder] = joint(spine_mid, 0.6, {{0.5, -3.2, -1.6}, 0.8, 1.8}, {0.8, 1.4, 1.3});
  t[head] = joint(spine_shoulder, 0.5, {{0.0, -1.3, -3.3}, 0.9, 1.9}, {0.9, 1.3, 1.3});
  t[spine_shoulder].spread = 0.7;
  t[head].spread = 0.85;
  t[spine_mid].twitch = t[spine_shoulder].twitch = t[head].twitch = 1.3;
  // The neck is the mean of its neighbours and has no draws.
  t[neck] = joint(neck, 0.0, {}, Vec3::Zero());
}

/// Sets the arms; hands are computed from the wrists.
void put_arms(Table& t) {
  t[shoulder_left] = joint(spine_shoulder, 0.5, {{0.6, -3.5, 2.1}, 1.4, 3.7}, {1.2, 1.4, 1.5});
  t[shoulder_right] = joint(spine_shoulder, 0.5, {{-2.2, -2.7, 1.0}, 1.9, 3.7}, {1.5, 1.5, 1.4});
  t[shoulder_left].spread = t[shoulder_right].spread = 0.5;
  t[elbow_left] = joint(shoulder_left, 0.4, {{-3.8, -1.3, 3.2}, 1.9, 5.2}, {2.5, 2.1, 1.7});
  t[elbow_right] = joint(shoulder_right, 0.4, {{3.4, -2.2, 3.2}, 1.1, 4.3}, {1.6, 2.4, 2.1});
  t[wrist_left] = joint(elbow_left, 0.54, {{-0.5, -0.6, -0.2}, 1.1, 3.5}, {1.5, 2.5, 1.6});
  t[wrist_right] = joint(elbow_right, 0.54, {{1.2, -0.2, -0.3}, 1.9, 4.0}, {1.9, 3.0, 2.7});
  for (const KinectJoint j : {elbow_left, elbow_right, wrist_left, wrist_right}) {
    t[j] = with_white(t[j], 0.2, 3.1);
    t[j].twitch = 1.3;
    t[j].spread = 0.75;
  }
  for (const KinectJoint j : {wrist_left, wrist_right}) t[j].twitch = 4.5;
  t[hand_left] = with_white(of_hand(t[wrist_left], wrist_left, 1.2), 0.7, 5.0);
  t[hand_right] = with_white(of_hand(t[wrist_right], wrist_right, 1.2), 0.7, 5.0);
  t[hand_tip_left] = with_white(of_hand(t[wrist_left], hand_left, 1.5), 1.8, 5.0);
  t[hand_tip_right] = with_white(of_hand(t[wrist_right], hand_right, 1.5), 1.8, 5.0);
  t[thumb_left] = with_white(of_hand(t[wrist_left], hand_left, 1.5), 3.0, 8.0);
  t[thumb_right] = with_white(of_hand(t[wrist_right], hand_right, 1.5), 3.0, 8.0);
}

/// Sets the legs; ankles and feet have the figures of on_the_ground().
void put_legs(Table& t) {
  t[hip_left] = joint(spine_base, 0.93, {{-2.1, -1.8, 0.8}, 2.7, 2.8}, {1.4, 1.5, 1.5});
  t[hip_right] = joint(spine_base, 0.93, {{2.6, -2.0, 0.3}, 2.3, 2.6}, {1.3, 1.5, 1.5});
  t[knee_left] = joint(hip_left, 0.1, {{-0.9, 5.0, 1.4}, 2.0, 4.5}, {1.6, 2.9, 2.3});
  t[knee_right] = joint(hip_right, 0.1, {{1.2, 4.6, 0.8}, 2.7, 4.5}, {1.3, 2.8, 2.3});
  t[ankle_left] = joint(knee_left, 0.45, {{-1.0, 5.4, 1.6}, 2.0, 3.6}, {1.8, 3.1, 2.4});
  t[ankle_right] = joint(knee_right, 0.45, {{0.4, 5.0, 1.6}, 2.0, 4.0}, {1.8, 3.1, 3.2});
  t[foot_left] = joint(ankle_left, 0.72, {{-1.9, 2.4, -1.7}, 3.0, 5.1}, {2.4, 3.2, 3.2});
  t[foot_right] = joint(ankle_right, 0.72, {{2.3, 1.7, -1.9}, 3.2, 5.1}, {2.1, 3.4, 3.8});
  for (const KinectJoint j : {knee_left, knee_right}) {
    t[j] = with_white(t[j], 0.19, 3.3);
    t[j].twitch = 1.1;
  }
  for (const KinectJoint j : {ankle_left, ankle_right, foot_left, foot_right}) {
    t[j] = on_the_ground(t[j]);
    if (j == foot_left || j == foot_right) t[j].twitch = 12.0;
  }
}

}  // namespace

const std::array<KinectJointNoise, kinect_joint_count>& kinect_joint_noise() {
  static const Table table = [] {
    Table t{};
    put_trunk(t);
    put_arms(t);
    put_legs(t);
    return t;
  }();
  return table;
}

}  // namespace kinalign
