// SPDX-License-Identifier: Apache-2.0
// The middle of a list of values. Single wrong values do not change it much.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kinalign {

/// The middle value, or the upper one of the two middle values. `values` must not be empty.
template <class Value>
Value upper_median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace kinalign
