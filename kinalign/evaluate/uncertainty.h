// SPDX-License-Identifier: Apache-2.0
// Tests of a stated uncertainty (models.md 8.10).
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// Standard deviations that a method states, [T,J] m per axis, above 0.
using Sigmas = std::span<const double>;

struct Coverage {
  std::size_t cells = 0;
  double within_50 = 0.0, within_90 = 0.0, within_95 = 0.0;  // shares of errors in that ellipsoid
  double mean_sigma_m = 0.0;    // at the same coverage the smaller is the sharper
  double log_likelihood = 0.0;  // mean over cells, of metres; the larger the better
  double best_factor = 0.0;     // times which all sigmas would be likeliest: 1 is right
};
/// Absent where no cell is valid.
std::optional<Coverage> coverage(const Sequence& sequence, Prediction prediction, Sigmas sigmas);

/// Errors of the cells between two deciles of sigma.
struct SigmaDecile {
  std::size_t cells = 0;
  double mean_sigma_m = 0.0;
  double rms_m = 0.0;  // per axis: of the size of sigma where the statement holds
};
/// From the smallest sigmas to the largest; fewer than ten where there are fewer cells.
std::vector<SigmaDecile> sigma_deciles(const Sequence& sequence, Prediction prediction,
                                       Sigmas sigmas);

}  // namespace kinalign
