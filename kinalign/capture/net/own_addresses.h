// SPDX-License-Identifier: Apache-2.0
// The addresses under which other machines reach this one.
#pragma once

#include <string>
#include <vector>

namespace kinalign {

/// Of interfaces that are up, IPv4 first; no loopback and no link-local ones.
std::vector<std::string> own_addresses();

/// Where clients reach who listens on these addresses (none: on all). In place of one that stands
/// for all of its kind, which nobody can send to, stand those of `own` that are of that kind.
std::vector<std::string> reachable_at(const std::vector<std::string>& listen,
                                      const std::vector<std::string>& own);

}  // namespace kinalign
