// SPDX-License-Identifier: Apache-2.0
// The addresses at which other machines can reach this machine.
#pragma once

#include <string>
#include <vector>

namespace kinalign {

/// Addresses of the active network interfaces, IPv4 first. Loopback and link-local addresses are
/// omitted.
std::vector<std::string> own_addresses();

/// Returns the addresses at which clients can reach a server that listens on `listen` (empty: on
/// all addresses). A wildcard address ("0.0.0.0", "::") is replaced by the addresses of the same
/// family in `own`, since clients can't send to a wildcard address.
std::vector<std::string> reachable_at(const std::vector<std::string>& listen,
                                      const std::vector<std::string>& own);

}  // namespace kinalign
