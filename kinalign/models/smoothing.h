// SPDX-License-Identifier: Apache-2.0
// Smooths sequences of numbers by least squares (Savitzky and Golay, Anal. Chem. 36(8), 1964).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kinalign {

/// Weights [window] of a window's values. The weighted sum is the value of a polynomial at the
/// place `at` (0 ... window - 1, may be fractional). The polynomial has that order and fits the
/// window best.
std::vector<double> polynomial_weights(std::size_t window, std::size_t order, double at);

struct Smoothing {
  std::size_t window = 9;  // frames, odd; 0 or 1: none
  std::size_t order = 2;   // order of the polynomial
  bool causal = false;     // true: the value at the window's last frame; false: at its centre

  bool operator==(const Smoothing&) const = default;
};

/// Smooths `values` [T,C] along T in place. The first frames (and, if not causal, the last ones)
/// use the polynomial of the first (last) whole window. If the sequence is shorter than the window,
/// the window is its length and the order at most length - 1.
void smooth(const Smoothing& how, std::size_t channels, std::span<float> values);

}  // namespace kinalign
