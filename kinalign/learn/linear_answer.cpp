// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/linear_answer.h"

#include <algorithm>

namespace kinalign {

LinearFit::LinearFit(std::int64_t channels, std::int64_t answers, std::int64_t kernel)
    : channels_(channels),
      kernel_(kernel),
      gram_(torch::zeros({kernel * channels + 1, kernel * channels + 1}, torch::kFloat64)),
      moment_(torch::zeros({kernel * channels + 1, answers}, torch::kFloat64)),
      squares_(torch::zeros({answers}, torch::kFloat64)) {}

void LinearFit::add(const torch::Tensor& input, const torch::Tensor& target,
                    const torch::Tensor& counts) {
  const std::int64_t half = kernel_ / 2;
  const auto padded = torch::constant_pad_nd(input.to(torch::kFloat64), {0, 0, half, half});
  // A row holds the channels of a frame with all their taps, in the order of a convolution's
  // weights.
  const auto windows = padded.unfold(0, kernel_, 1).reshape({-1, kernel_ * channels_});
  const auto rows = counts.nonzero().flatten();
  const auto ones = torch::ones({windows.size(0), 1}, torch::kFloat64);
  const auto features = torch::cat({windows, ones}, 1).index_select(0, rows);
  const auto targets = target.to(torch::kFloat64).index_select(0, rows);
  gram_ += torch::mm(features.t(), features);
  moment_ += torch::mm(features.t(), targets);
  squares_ += targets.pow(2).sum(0);
  rows_ += static_cast<double>(rows.size(0));
}

LinearAnswer LinearFit::solved(double penalty) const {
  const std::int64_t width = kernel_ * channels_, answers = moment_.size(1);
  auto penalties = torch::full({width + 1}, penalty, torch::kFloat64);
  // The bias gets only this small penalty, which keeps the system solvable if no row was added.
  penalties[width] = 1e-6;
  const auto weights = torch::linalg_solve(gram_ + torch::diag(penalties), moment_);
  // The squared error follows from the same sums: y'y - 2 w'm + w'G w.
  const auto left =
      squares_ - 2.0 * (weights * moment_).sum(0) + (weights * torch::mm(gram_, weights)).sum(0);
  return {weights.slice(0, 0, width)
              .t()
              .reshape({answers, channels_, kernel_})
              .to(torch::kFloat32)
              .contiguous(),
          weights[width].to(torch::kFloat32),
          (left / std::max(rows_, 1.0)).clamp_min(0.0).to(torch::kFloat32)};
}

}  // namespace kinalign
