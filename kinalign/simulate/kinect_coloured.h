// SPDX-License-Identifier: Apache-2.0
// What wanders: a smooth error of each joint whose size goes with how much the body moves, and the
// tracker's soft hold on the lengths of bones.
#pragma once

#include "kinalign/simulate/kinect_scene.h"

namespace kinalign {

/// A Gaussian process of unit variance, critically damped: two equal first-order filters in series,
/// with autocorrelation (1 + x) exp(-x), x = 2.146 t / tau, which is 1/e at tau. Its clock may run
/// quicker or slower from step to step; the variance stays.
struct SmoothNoise {
  double value = 0.0, slope = 0.0;  // of the process; of it by x

  static constexpr double per_tau = 2.146;
};

/// The exact transition over a step of x (from the covariance 1 - A A^T of the linear system).
class SmoothStep {
 public:
  explicit SmoothStep(double x);
  /// `first`, `second`: independent standard normal draws.
  void run(SmoothNoise& noise, double first, double second) const {
    const double value = keep_ * ((1.0 + x_) * noise.value + x_ * noise.slope);
    const double slope = keep_ * (-x_ * noise.value + (1.0 - x_) * noise.slope);
    noise.value = value + value_first_ * first;
    noise.slope = slope + slope_first_ * first + slope_second_ * second;
  }

 private:
  double x_, keep_, value_first_, slope_first_, slope_second_;
};

inline constexpr double kinect_frame_s = 1.0 / 30.0;

/// Adds to `joints` [T,25,3] m.
void add_coloured_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Draws how much longer or shorter than the true one each limb's bone is, and the hips' width,
/// towards its mean over the take. Against the truth, since the markers' bones stretch with the
/// pose (upper arms by centimetres): to hold those was to add an error that goes with the pose.
void hold_bones(const KinectScene& scene, std::span<double> joints);

}  // namespace kinalign
