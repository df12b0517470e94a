// SPDX-License-Identifier: Apache-2.0
// A word that nobody knows: which known one was meant.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The known name nearest to `name`, by single letters put in, left out, changed or swapped, where
/// no more than a third of its letters differ; else the first that it begins, by three letters or
/// more; else empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// The error for a name that is not known, with the nearest known one, or the first few
/// where none is near: "a key of [align] (nearest: gap_ms)".
Error unknown_name(std::string_view name, const std::string& what,
                   const std::vector<std::string>& known);

}  // namespace kinalign
