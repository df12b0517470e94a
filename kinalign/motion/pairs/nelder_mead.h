// SPDX-License-Identifier: Apache-2.0
// The simplex method of Nelder and Mead (Computer Journal 7(4), 1965) with SciPy's coefficients,
// first simplex and tolerances, so that both give the same result.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace kinalign {

using CostFunction = std::function<double(std::span<const double>)>;

/// The place near `start` with the least cost. Ends when place and cost are exact to 1e-4, or after
/// 200 calls for each number of the place.
std::vector<double> minimise(const CostFunction& cost, const std::vector<double>& start);

}  // namespace kinalign
