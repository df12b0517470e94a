// SPDX-License-Identifier: Apache-2.0
// The linear answer that a correcting network begins with: ridge regression on a few frames (Hoerl
// and Kennard, 1970), in closed form.
#pragma once

#include <torch/torch.h>

namespace kinalign {

/// A convolution over time, as torch::conv1d with zeros beyond both ends takes it.
struct LinearAnswer {
  torch::Tensor weight;  // [N,C,kernel] float32
  torch::Tensor bias;    // [N]
  torch::Tensor left;    // [N] mean square of what it leaves over of the rows
};

class LinearFit {
 public:
  /// `kernel`: frames, odd.
  LinearFit(std::int64_t channels, std::int64_t answers, std::int64_t kernel);

  /// `input` [T,C], `target` [T,N]; `counts` [T] bool: the frames that count.
  void add(const torch::Tensor& input, const torch::Tensor& target, const torch::Tensor& counts);

  /// `penalty`: of squared weights beside the sum of squared errors. All zeros where no row counts.
  LinearAnswer solved(double penalty) const;

 private:
  std::int64_t channels_, kernel_;
  torch::Tensor gram_, moment_, squares_;  // float64
  double rows_ = 0.0;
};

}  // namespace kinalign
