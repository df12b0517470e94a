// SPDX-License-Identifier: Apache-2.0
// Smoothing by least squares (Savitzky and Golay, Anal. Chem. 36(8), 1964) of sequences of numbers.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kinalign {

/// Weights [window] of the value at `at` (0 ... window - 1, may lie between) of the polynomial of
/// that order which fits the window's values best.
std::vector<double> polynomial_weights(std::size_t window, std::size_t order, double at);

struct Smoothing {
  std::size_t window = 9;  // frames, odd; 0 or 1: none
  std::size_t order = 2;
  bool causal = false;  // the value at the window's last frame; else at its centre

  bool operator==(const Smoothing&) const = default;
};

/// `values` [T,C], smoothed along T in place. The first frames (and, if not causal, the last ones)
/// take the polynomial of the first (last) whole window. A sequence shorter than the window has a
/// window of its own length; its order is then at most length - 1.
void smooth(const Smoothing& how, std::size_t channels, std::span<float> values);

}  // namespace kinalign
