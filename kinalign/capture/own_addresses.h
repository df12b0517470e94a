// SPDX-License-Identifier: Apache-2.0
// The addresses under which other machines reach this one.
#pragma once

#include <string>
#include <vector>

namespace kinalign {

/// Of interfaces that are up, IPv4 first; no loopback and no link-local ones.
std::vector<std::string> own_addresses();

}  // namespace kinalign
