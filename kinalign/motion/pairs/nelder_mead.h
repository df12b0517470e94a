// SPDX-License-Identifier: Apache-2.0
// The simplex of Nelder and Mead (Computer Journal 7(4), 1965) with SciPy's coefficients, first
// simplex and tolerances, so that both end at the same place.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace kinalign {

using CostFunction = std::function<double(std::span<const double>)>;

/// The place near `start` where the cost is least: to 1e-4 in the place and in the cost, or after
/// 200 calls for each of its numbers.
std::vector<double> minimise(const CostFunction& cost, const std::vector<double>& start);

}  // namespace kinalign
