// SPDX-License-Identifier: Apache-2.0
// The counts and sizes that several verbs print.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// "1 take", "3,000 takes".
std::string counted(std::uint64_t count, std::string_view one);
/// "1 person", "3 people".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);
/// "85 kB", "1.6 MB".
/// Sizes are decimal (1 kB = 1000 bytes), as disks are sold and file managers show them.
std::string size_text(std::uint64_t bytes);
/// A name of JSON in words: "wrong_mac" gives "wrong mac".
std::string spaced(std::string_view name);

}  // namespace kinalign
