// SPDX-License-Identifier: Apache-2.0
// Filters of joints without learning, the baseline for every network. All of them take frames at an
// even rate, accept missing joints, and return every joint.
#pragma once

#include "kinalign/models/joint_frames.h"

namespace kinalign {

/// Repeats the last position at which a joint was seen. A joint that stays inferred for more than
/// 0.2 s counts as missing from then on. Causal.
void hold(JointFrames& body, double rate_hz);

/// The values were found by trials on UI-PRMD. A lower `least_hz` makes a still joint calmer; a
/// higher `slope` lets the filter follow fast motion.
struct OneEuro {
  double least_hz = 1.2;       // cut-off frequency at rest, Hz
  double slope = 3.0;          // Hz added to the cut-off for each m/s
  double derivative_hz = 1.0;  // cut-off frequency of the speed's low-pass
};
/// One Euro filter (Casiez, Roussel, Vogel, CHI 2012). The joint's speed in space decides one
/// cut-off frequency for all three axes. Causal.
void one_euro(const OneEuro& how, JointFrames& body, double rate_hz);

struct Kalman {
  double tracked_m = 0.01, inferred_m = 0.05;  // standard deviation of a measurement, per axis
  double jerk = 1e3;                           // white jerk's power, m^2/s^5
};
/// A Kalman filter of position, speed and acceleration for each axis, followed by the smoother of
/// Rauch, Tung and Striebel. A missing joint gives no measurement.
void kalman_smooth(const Kalman& how, JointFrames& body, double rate_hz);

}  // namespace kinalign
