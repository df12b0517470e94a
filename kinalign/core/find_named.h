// SPDX-License-Identifier: Apache-2.0
// Looks up an element of a list by its member `name`.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

namespace kinalign {

/// The first element of `all` with that name; nullptr if there is none. The search starts at the
/// front, so it is for short lists.
template <class All>
auto* find_named(All& all, std::string_view name) {
  const auto found = std::find_if(std::begin(all), std::end(all),
                                  [&](const auto& one) { return one.name == name; });
  return found == std::end(all) ? nullptr : &*found;
}

}  // namespace kinalign
