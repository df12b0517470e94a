// SPDX-License-Identifier: Apache-2.0
// Makes the names of joints or markers unique, because a take can't contain a name twice.
#pragma once

#include <string>
#include <vector>

namespace kinalign {

/// Appends #2, #3, ... to a repeated name: the first number that gives a new name.
std::vector<std::string> distinct_names(const std::vector<std::string>& names);

}  // namespace kinalign
