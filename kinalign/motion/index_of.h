// SPDX-License-Identifier: Apache-2.0
// The place of a name in a list of joints, nodes or bones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// The index of `name` in `names`; empty if it is absent.
inline std::optional<std::size_t> index_of(std::span<const std::string> names,
                                           std::string_view name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

}  // namespace kinalign
