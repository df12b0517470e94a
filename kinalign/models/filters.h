// SPDX-License-Identifier: Apache-2.0
// Filters of joints without learning: the yardstick of every network. All of them take frames at an
// even rate, may miss joints, and answer for every joint.
#pragma once

#include "kinalign/models/joint_frames.h"

#include <vector>

namespace kinalign {

/// The last place where a joint was tracked; an inferred joint is taken for missing after 0.2 s.
/// Causal.
void hold(JointFrames& body, double rate_hz);

struct OneEuro {
  double least_hz = 1.2;  // cut-off at rest
  double slope = 3.0;     // Hz more for each m/s
  double derivative_hz = 1.0;
};
/// Casiez, Roussel, Vogel, CHI 2012, with the speed of the joint in space for all its axes. Causal.
void one_euro(const OneEuro& how, JointFrames& body, double rate_hz);

struct Kalman {
  double tracked_m = 0.01, inferred_m = 0.05;  // standard deviation of a measurement, of an axis
  double jerk = 1e3;                           // white jerk's power, m^2/s^5
};
/// A Kalman filter of place, speed and acceleration of each axis, and Rauch, Tung and Striebel's
/// smoother behind it. A missing joint is not measured.
void kalman_smooth(const Kalman& how, JointFrames& body, double rate_hz);

}  // namespace kinalign
