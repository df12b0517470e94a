// SPDX-License-Identifier: Apache-2.0
// Suggests the known name that the user probably meant by an unknown name.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The known name nearest to `name`, counting inserted, missing, changed and swapped letters. At
/// most a third of the letters of `name` may differ. If no name is near enough: the first known
/// name that begins with `name`, if `name` has at least three letters. Otherwise empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// The error for an unknown name. The message suggests the nearest known name, or lists the first
/// few: "a key of [align] (nearest: gap_ms)".
Error unknown_name(std::string_view name, const std::string& what,
                   const std::vector<std::string>& known);

}  // namespace kinalign
