// SPDX-License-Identifier: Apache-2.0
// Addresses as the system's sockets have them, UDP's and TCP's alike.
#pragma once

#include <netdb.h>

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

using FoundAddress = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

/// Of a numeric address; `type`: SOCK_DGRAM, SOCK_STREAM. nullptr: it is none.
FoundAddress find_address(const std::string& address, std::uint16_t port, int type);

/// The port that a socket is bound to.
std::uint16_t bound_port(int fd);

}  // namespace kinalign
