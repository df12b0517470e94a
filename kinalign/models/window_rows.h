// SPDX-License-Identifier: Apache-2.0
// Arrays of rows, and windows of them that move on: the first rows leave a window. Windows are
// short, so moving the rest costs little, and spans over a window stay possible.
#pragma once

#include <cstddef>
#include <vector>

namespace kinalign {

/// Removes the first `count` values.
template <class T>
void erase_first(std::vector<T>& all, std::size_t count) {
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
}

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// A copy of one row of `width` values.
template <class T>
std::vector<T> row_of(const std::vector<T>& all, std::size_t row, std::size_t width) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(row * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

}  // namespace kinalign
