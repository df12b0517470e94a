// SPDX-License-Identifier: Apache-2.0
// The addresses under which other machines can reach this one.
#pragma once

#include <string>
#include <vector>

namespace kinalign {

/// Addresses of the interfaces that are up, IPv4 first. Loopback and link-local addresses are left
/// out.
std::vector<std::string> own_addresses();

/// Addresses under which clients can reach a server that listens on `listen` (empty: on all). A
/// wildcard address ("0.0.0.0", "::") is replaced by the addresses of `own` of the same family,
/// since clients cannot send to a wildcard address.
std::vector<std::string> reachable_at(const std::vector<std::string>& listen,
                                      const std::vector<std::string>& own);

}  // namespace kinalign
