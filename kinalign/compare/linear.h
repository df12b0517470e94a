// SPDX-License-Identifier: Apache-2.0
// Methods that are fitted in closed form: the mean offset of each joint, and ridge regression over
// nine frames. Both are those of UI-PRMD's protocol.
#pragma once

#include "kinalign/models/denoise_features.h"
#include "kinalign/models/pairs.h"

#include <array>
#include <memory>
#include <vector>

namespace kinalign {

/// Each output joint is its input joint moved by a constant vector in the body's heading.
class MeanOffset {
 public:
  MeanOffset(const DenoiseLayout& layout, const std::vector<const Pair*>& learnt);
  /// [T,Jout,3] m.
  std::vector<float> clean(const DenoiseLayout& layout, const JointFrames& body) const;

 private:
  std::vector<float> mean_;  // [Jout,3] m
};

/// The offset as a linear function of the input's joints in nine frames, in the heading of the
/// middle one.
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

/// How much larger ridge's errors are on people it has not seen than on those it was fitted to,
/// people left out one by one, or in at most five groups: a quantile of the first over the 90 %
/// quantile of the second. Few people do not show how much people differ: for n of them the first
/// is the one of 0.9 (n + 1) / n, at most 0.93 (Lee, Barber, Willett, «Distribution-free inference
/// with hierarchical data», 2023). 1.5 where there is one person alone.
double unseen_ratio(const DenoiseLayout& layout, const std::vector<Pair>& pairs);

/// The input joints that stand for the outputs [T,Jout,3] m, missing ones filled.
std::vector<float> base_joints(const DenoiseLayout& layout, JointFrames body);

}  // namespace kinalign
