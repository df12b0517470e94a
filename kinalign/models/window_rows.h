// SPDX-License-Identifier: Apache-2.0
// Arrays of a window that moves on: the first rows leave it.
#pragma once

#include <cstddef>
#include <vector>

namespace kinalign {

/// Removes the first `count` values.
/// Windows are short, so moving the rest costs little, and spans over the window stay possible.
template <class T>
void erase_first(std::vector<T>& all, std::size_t count) {
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace kinalign
