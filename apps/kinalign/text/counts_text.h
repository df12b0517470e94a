// SPDX-License-Identifier: Apache-2.0
// Numbers and sizes as text, for several verbs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// A number with its noun: "1 take", "3,000 takes".
std::string counted(std::uint64_t count, std::string_view one);
/// A number with a noun of irregular plural: "1 person", "3 people".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);
/// A size: "85 kB", "1.6 MB". 1 kB is 1000 bytes, as disks are sold and file managers show them.
std::string size_text(std::uint64_t bytes);
/// Turns a name in JSON into words: "wrong_mac" gives "wrong mac".
std::string spaced(std::string_view name);

}  // namespace kinalign
