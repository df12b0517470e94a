// SPDX-License-Identifier: Apache-2.0
// Datagrams of SlimeVR's trackers, composed by hand from docs/formats/slimevr.md.
#pragma once

#include "kinalign/protocols/slimevr/packet.h"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace kinalign {

using Bytes = std::vector<std::uint8_t>;

inline Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

inline Bytes slime_datagram(std::uint32_t type, std::uint64_t number, const Bytes& body) {
  Bytes bytes;
  for (int i = 3; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(type >> (8 * i)));
  for (int i = 7; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

struct HandshakeSaid {
  SlimeMac mac{0xde, 0xad, 0xbe, 0xef, 0, 1};
  std::uint8_t protocol = 22;
};

/// 67 bytes.
inline Bytes handshake_packet(const HandshakeSaid& said) {
  const auto text = [](const std::string& t) {
    return joined({{static_cast<std::uint8_t>(t.size())}, Bytes(t.begin(), t.end())});
  };
  return slime_datagram(3, 0,
                        joined({{0, 0, 0, 9, 0, 0, 0, 4, 0, 0, 0, 2},
                                Bytes(12),
                                {0, 0, 0, said.protocol},
                                text("0.7.0"),
                                Bytes(said.mac.begin(), said.mac.end()),
                                {0},
                                text("maker"),
                                text(""),
                                text("tracker"),
                                text(""),
                                text("")}));
}

}  // namespace kinalign
