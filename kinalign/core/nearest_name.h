// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The known name nearest to `name`, by single letters put in, left out, changed or swapped, else
/// the first that it begins; empty where more than a third of its letters differ.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

}  // namespace kinalign
