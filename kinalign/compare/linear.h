// SPDX-License-Identifier: Apache-2.0
// Two methods that are computed directly, without training a network: the mean offset of each
// joint, and ridge regression over nine frames. Both follow UI-PRMD's protocol.
#pragma once

#include "kinalign/models/denoise_features.h"
#include "kinalign/models/pairs.h"

#include <array>
#include <memory>
#include <vector>

namespace kinalign {

/// Moves each joint by a constant vector in the axes of the body's heading. This simplest method
/// only removes the difference between the definitions of the joints.
class MeanOffset {
 public:
  MeanOffset(const DenoiseLayout& layout, const std::vector<const Pair*>& learnt);
  /// Returns the cleaned joints [T,Jout,3] m.
  std::vector<float> clean(const DenoiseLayout& layout, const JointFrames& body) const;

 private:
  std::vector<float> mean_;  // [Jout,3] m
};

/// Predicts the offset of each joint as a linear function of the input joints in nine frames, in
/// the heading of the middle frame. `penalty` keeps the weights small; features are in units of 5
/// cm. `Fit` is defined in the .cpp file, so that this header does not include Eigen's solvers.
class Ridge {
 public:
  Ridge(const DenoiseLayout& layout, const std::vector<const Pair*>& learnt,
        double penalty = 300.0);
  Ridge(const Ridge&) = delete;
  Ridge& operator=(const Ridge&) = delete;
  Ridge(Ridge&&) noexcept;
  Ridge& operator=(Ridge&&) noexcept;
  ~Ridge();
  std::vector<float> clean(const DenoiseLayout& layout, const JointFrames& body) const;

 private:
  struct Fit;
  std::unique_ptr<Fit> fit_;
};

/// Returns how much larger ridge regression's errors are for unseen people than for people of the
/// training. People are left out one by one, or in at most five groups. The result is a quantile of
/// the errors for unseen people, divided by the 90 % quantile for the others.
///
/// A few people do not show how much people differ. For n people the first quantile is therefore
/// 0.9 (n + 1) / n, at most 0.93 (Lee, Barber, Willett, «Distribution-free inference with
/// hierarchical data», 2023). The result for a single person is 1.5.
double unseen_ratio(const DenoiseLayout& layout, const std::vector<Pair>& pairs);

/// Returns the input joints that correspond to the outputs, [T,Jout,3] m; missing positions are
/// filled.
std::vector<float> base_joints(const DenoiseLayout& layout, JointFrames body);

}  // namespace kinalign
