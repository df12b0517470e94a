// SPDX-License-Identifier: Apache-2.0
// A linear map as the start of a network that outputs corrections: ridge regression on a few frames
// (Hoerl and Kennard, 1970), in closed form.
#pragma once

#include <torch/torch.h>

namespace kinalign {

/// A convolution over time in the form of torch::conv1d, with zeros beyond both ends.
struct LinearAnswer {
  torch::Tensor weight;  // [N,C,kernel] float32
  torch::Tensor bias;    // [N] one number for each output
  torch::Tensor left;    // [N] mean square error over the rows
};

/// Keeps the sums of the normal equations, not the rows, so memory does not grow with the data.
class LinearFit {
 public:
  /// `kernel`: number of frames, odd.
  LinearFit(std::int64_t channels, std::int64_t answers, std::int64_t kernel);

  /// Adds a sequence: `input` [T,C], `target` [T,N]; `counts` [T] bool selects the frames.
  void add(const torch::Tensor& input, const torch::Tensor& target, const torch::Tensor& counts);

  /// `penalty`: factor of the squared weights, added to the sum of squared errors. All zeros if no
  /// row was added.
  LinearAnswer solved(double penalty) const;

 private:
  std::int64_t channels_, kernel_;
  torch::Tensor gram_, moment_, squares_;  // float64
  double rows_ = 0.0;
};

}  // namespace kinalign
