// SPDX-License-Identifier: Apache-2.0
// Methods that are fitted in closed form: the mean offset of each joint, and ridge regression over
// nine frames. Both follow UI-PRMD's protocol.
#pragma once

#include "kinalign/models/denoise_features.h"
#include "kinalign/models/pairs.h"

#include <array>
#include <memory>
#include <vector>

namespace kinalign {

/// Each output joint is its input joint moved by a constant vector in the body's heading. The
/// simplest method: it removes the difference between the joints' definitions and nothing else.
class MeanOffset {
 public:
  MeanOffset(const DenoiseLayout& layout, const std::vector<const Pair*>& learnt);
  /// The cleaned joints [T,Jout,3] m.
  std::vector<float> clean(const DenoiseLayout& layout, const JointFrames& body) const;

 private:
  std::vector<float> mean_;  // [Jout,3] m
};

/// The offset is a linear function of the input's joints in nine frames, in the heading of the
/// middle frame. `penalty` keeps the weights small; features are in units of 5 cm. Eigen's dense
/// solvers stay in the .cpp file, hence `Fit`.
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

/// The ratio of ridge's errors on unseen people to those on the people it was fitted to. People are
/// left out one by one, or in at most five groups. The ratio is a quantile of the first errors over
/// the 90 % quantile of the second. Few people do not show how much people differ: for n of them
/// the first quantile is 0.9 (n + 1) / n, at most 0.93 (Lee, Barber, Willett, «Distribution-free
/// inference with hierarchical data», 2023). 1.5 for a single person.
double unseen_ratio(const DenoiseLayout& layout, const std::vector<Pair>& pairs);

/// The input joints that stand for the outputs, [T,Jout,3] m, with missing ones filled.
std::vector<float> base_joints(const DenoiseLayout& layout, JointFrames body);

}  // namespace kinalign
