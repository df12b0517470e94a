// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/smoothing.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>

namespace kinalign {

namespace {

/// Powers 0 ... order of `x`.
Eigen::VectorXd powers(double x, std::size_t order) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(order) + 1);
  double value = 1.0;
  for (Eigen::Index i = 0; i < out.size(); ++i, value *= x) out(i) = value;
  return out;
}

}  // namespace

std::vector<double> polynomial_weights(std::size_t window, std::size_t order, double at) {
  const auto n = static_cast<Eigen::Index>(window);
  // Times are scaled to -1 ... 1, because high powers of frame numbers would make the equations
  // badly conditioned.
  const double middle = (static_cast<double>(window) - 1.0) / 2.0, scale = std::max(middle, 1.0);
  Eigen::MatrixXd design(n, static_cast<Eigen::Index>(order) + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    design.row(i) = powers((static_cast<double>(i) - middle) / scale, order).transpose();
  }
  const Eigen::VectorXd here = powers((at - middle) / scale, order);
  const Eigen::VectorXd weights = design * (design.transpose() * design).ldlt().solve(here).eval();
  return {weights.begin(), weights.end()};
}

void smooth(const Smoothing& how, std::size_t channels, std::span<float> values) {
  const std::size_t frames = channels == 0 ? 0 : values.size() / channels;
  const std::size_t window = std::min(how.window, frames);
  if (window < 2) return;
  const std::size_t order = std::min(how.order, window - 1);
  const std::size_t centre = how.causal ? window - 1 : window / 2;
  // One set of weights for each place in a window; frames in the middle all use the same set.
  std::vector<std::vector<double>> weights(window);
  const std::vector<float> before(values.begin(), values.end());
  for (std::size_t t = 0; t < frames; ++t) {
    // Near both ends the window stays whole and the frame lies off its centre.
    const std::size_t begin = std::min(t > centre ? t - centre : std::size_t{0}, frames - window);
    std::vector<double>& w = weights[t - begin];
    if (w.empty()) w = polynomial_weights(window, order, static_cast<double>(t - begin));
    for (std::size_t c = 0; c < channels; ++c) {
      double sum = 0.0;
      for (std::size_t i = 0; i < window; ++i) sum += w[i] * before[(begin + i) * channels + c];
      values[t * channels + c] = static_cast<float>(sum);
    }
  }
}

}  // namespace kinalign
