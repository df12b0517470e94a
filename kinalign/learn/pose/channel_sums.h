// SPDX-License-Identifier: Apache-2.0
// Mean and standard deviation of channels over many frames.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kinalign {

/// The sums are double, so that a variance of many frames keeps its digits. Frames are added in any
/// number of pieces.
class ChannelSums {
 public:
  explicit ChannelSums(std::size_t channels) : sum_(channels, 0.0), squares_(channels, 0.0) {}

  /// Adds the frames of `input` [T,C].
  void add(const std::vector<float>& input) {
    for (std::size_t i = 0; i < input.size(); ++i) {
      const double value = static_cast<double>(input[i]);
      sum_[i % sum_.size()] += value;
      squares_[i % sum_.size()] += value * value;
    }
    frames_ += static_cast<double>(input.size() / sum_.size());
  }

  float mean(std::size_t c) const { return static_cast<float>(sum_[c] / frames_); }
  float deviation(std::size_t c) const {
    const double mean = sum_[c] / frames_, variance = squares_[c] / frames_ - mean * mean;
    return static_cast<float>(std::sqrt(std::max(variance, 0.0)));
  }

 private:
  std::vector<double> sum_, squares_;
  double frames_ = 0.0;
};

}  // namespace kinalign
