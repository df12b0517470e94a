// SPDX-License-Identifier: Apache-2.0
// Slow, smooth errors of each joint. One part depends on the pose, the other on time; the second
// grows when the pose changes. This file also has the tracker's tendency to keep bone lengths
// constant.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// A Gaussian process of unit variance and third order: three equal first-order filters in series.
/// Its autocorrelation is (1 + x + x^2 / 3) exp(-x) with x = 2.904 t / tau, which is 1/e at t =
/// tau. Its time may run at a different rate in each step; the variance stays the same.
struct SmoothNoise {
  Vec3 state = Vec3::Zero();  // the value and its first and second derivative with respect to x

  double value() const { return state[0]; }
  static constexpr double per_tau = 2.904;
};

/// The transition over a step of x, with two random draws. It neglects a part of the covariance P -
/// A P A^T, namely the part that is left when the derivatives are known. That part is 1e-4 of the
/// variance for the usual x of 0.3, and 0.2 % for 0.55.
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

/// Adds the slow errors to `joints` [T,25,3] m.
void add_coloured_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Moves the length error of each limb bone, and of the distance between the hips, towards its mean
/// over the take. The error is the difference from the true length. True lengths vary, because
/// bones between markers stretch with the pose (upper arms by centimetres). Constant lengths would
/// therefore add an error that depends on the pose.
void hold_bones(const KinectScene& scene, std::span<double> joints);

}  // namespace kinalign
