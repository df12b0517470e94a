// SPDX-License-Identifier: Apache-2.0
// Socket addresses of the system, for UDP and TCP.
#pragma once

#include <netdb.h>

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

using FoundAddress = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

/// Converts a numeric address. `type`: SOCK_DGRAM or SOCK_STREAM. nullptr: not a numeric address.
FoundAddress find_address(const std::string& address, std::uint16_t port, int type);

/// The port that a socket is bound to.
std::uint16_t bound_port(int fd);

}  // namespace kinalign
