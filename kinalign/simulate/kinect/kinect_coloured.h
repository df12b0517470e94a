// SPDX-License-Identifier: Apache-2.0
// What wanders: a smooth error of each joint, part of it bound to the pose and part to the moment,
// growing as the pose changes; and the tracker's soft hold on the lengths of bones.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// A Gaussian process of unit variance and third order: three equal first-order filters in series,
/// with autocorrelation (1 + x + x^2 / 3) exp(-x), x = 2.904 t / tau, which is 1/e at tau. Its
/// clock may run quicker or slower from step to step; the variance stays.
struct SmoothNoise {
  Vec3 state = Vec3::Zero();  // the value, its first and second derivative by x

  double value() const { return state[0]; }
  static constexpr double per_tau = 2.904;
};

/// The transition over a step of x. Two draws: what is left of the covariance P - A P A^T when the
/// derivatives are known is left out: 1e-4 of the variance for the usual x of 0.3, 0.2 % for 0.55.
class SmoothStep {
 public:
  explicit SmoothStep(double x);
  /// `first`, `second`: independent standard normal draws.
  void run(SmoothNoise& noise, double first, double second) const {
    noise.state = Vec3(transition_ * noise.state) + first_ * first + second_ * second;
  }

 private:
  Eigen::Matrix3d transition_;
  Vec3 first_, second_;
};

inline constexpr double kinect_frame_s = 1.0 / 30.0;

/// Adds to `joints` [T,25,3] m.
void add_coloured_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Draws how much longer or shorter than the true one each limb's bone is, and the hips' width,
/// towards its mean over the take. Against the truth, since the markers' bones stretch with the
/// pose (upper arms by centimetres): to hold those was to add an error that goes with the pose.
void hold_bones(const KinectScene& scene, std::span<double> joints);

}  // namespace kinalign
