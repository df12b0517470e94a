// SPDX-License-Identifier: Apache-2.0
// Addresses of hosts and networks. IPv4 and IPv6 share one type.
#pragma once

#include "kinalign/core/error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kinalign {

/// 16 bytes of an IPv6 address. An IPv4 address a.b.c.d is stored as ::ffff:a.b.c.d (RFC 4291
/// section 2.5.5.2).
using HostAddress = std::array<std::uint8_t, 16>;

constexpr HostAddress mapped_ipv4(std::span<const std::uint8_t, 4> bytes) {
  return {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, bytes[0], bytes[1], bytes[2], bytes[3]};
}

constexpr bool is_ipv4(const HostAddress& address) {
  for (std::size_t i = 0; i < 10; ++i) {
    if (address[i] != 0) return false;
  }
  return address[10] == 0xff && address[11] == 0xff;
}

/// Text such as "192.168.7.20" or "fd00::1".
std::string to_string(const HostAddress& address);

/// A node's address and UDP port.
struct NodeAddress {
  HostAddress host{};
  std::uint16_t port = 0;

  bool operator==(const NodeAddress&) const = default;
};

/// The part of an address that identifies an unknown sender for the rate limit. For IPv4 it is the
/// whole address. For IPv6 it is the 64-bit network, because one customer usually has a whole /64.
constexpr std::span<const std::uint8_t, 8> address_prefix(const HostAddress& address) {
  const std::span<const std::uint8_t, 16> bytes(address);
  return is_ipv4(address) ? bytes.last<8>() : bytes.first<8>();
}

/// All addresses whose first `bits` bits equal those of `prefix`.
struct AddressBlock {
  HostAddress prefix{};
  std::size_t bits = 0;  // prefix length in the 16 bytes; for IPv4 its prefix length plus 96

  bool has(const HostAddress& address) const;
};

/// Parses "192.168.7.0/24", "fd00::/8" or a single address.
Result<AddressBlock> parse_network(const std::string& text);

}  // namespace kinalign
