// SPDX-License-Identifier: Apache-2.0
// Makes the names of joints or markers unique, because a take can't hold a name twice.
#pragma once

#include <string>
#include <vector>

namespace kinalign {

/// A repeated name gets #2, #3, ..., the first number that gives no other name of the list.
std::vector<std::string> distinct_names(const std::vector<std::string>& names);

}  // namespace kinalign
