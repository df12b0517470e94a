// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/host_address.h"

#include "kinalign/core/numbers.h"

#include <arpa/inet.h>

#include <optional>

namespace kinalign {

namespace {

std::optional<HostAddress> parse_address(const std::string& text) {
  std::array<std::uint8_t, 4> four{};
  if (::inet_pton(AF_INET, text.c_str(), four.data()) == 1) return mapped_ipv4(four);
  HostAddress address{};
  if (::inet_pton(AF_INET6, text.c_str(), address.data()) == 1) return address;
  return std::nullopt;
}

std::optional<std::size_t> parse_bits(const std::string& text, std::size_t most) {
  std::size_t bits = 0;
  return parse_integer(text, bits) && bits <= most ? std::optional(bits) : std::nullopt;
}

}  // namespace

std::string to_string(const HostAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const bool four = is_ipv4(address);
  ::inet_ntop(four ? AF_INET : AF_INET6, address.data() + (four ? 12 : 0), text.data(),
              text.size());
  return text.data();
}

bool AddressBlock::has(const HostAddress& address) const {
  for (std::size_t i = 0; i < bits / 8; ++i) {
    if (address[i] != prefix[i]) return false;
  }
  if (bits % 8 == 0) return true;
  const unsigned differing = address[bits / 8] ^ prefix[bits / 8];
  return differing >> (8 - bits % 8) == 0;
}

Result<AddressBlock> parse_network(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto address = parse_address(text.substr(0, slash));
  const bool four = address && is_ipv4(*address) && text.find(':') == std::string::npos;
  const std::size_t most = four ? 32 : 128;
  const auto bits =
      slash == std::string::npos ? std::optional(most) : parse_bits(text.substr(slash + 1), most);
  if (!address || !bits) {
    return Failure(Error{"", 0, "an address or a network, such as 192.168.7.0/24", shown(text)});
  }
  return AddressBlock{*address, four ? *bits + 96 : *bits};
}

}  // namespace kinalign
