// SPDX-License-Identifier: Apache-2.0
// The rule for a node's datagrams: an accepted one encodes again to the same bytes, and a refused
// one changes nothing. No fuzzer guesses a MAC, so the input's first byte says how the rest is
// repaired: 0 not at all, 1 all but the fields, 2 the same with a MAC.
#pragma once

#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/node_layout.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace kinalign {

constexpr MacKey fuzz_key{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// Sets magic, version, type, length, the MAC's flag, MAC and CRC to correct values.
inline void mend(std::vector<std::uint8_t>& datagram, DatagramType type, const MacKey* key) {
  if (datagram.size() < node_datagram_size(0, key != nullptr)) return;
  const auto flags = static_cast<std::uint8_t>(datagram[20] & ~mac_flag);
  std::vector<std::uint8_t> head(node_head_size);
  begin_datagram(head, head.size(), {type, {}, 0, 0, 0}, key);
  std::copy_n(head.begin(), 6, datagram.begin());
  ByteWriter(std::span(datagram).subspan(6)).put(static_cast<std::uint16_t>(datagram.size()));
  datagram[20] = static_cast<std::uint8_t>(flags | (key != nullptr ? mac_flag : 0));
  if (seal(datagram, key).size() != datagram.size()) std::abort();
}

template <class Datagram>
void check_again(const std::vector<std::uint8_t>& datagram, const MacKey* key) {
  Envelope envelope;
  if (open_envelope(datagram, envelope) != NodeRefusal::none) {
    if (!envelope.datagram.empty()) std::abort();
    return;
  }
  Datagram decoded;
  if (decode(envelope, key, decoded) != NodeRefusal::none) {
    if (decoded != Datagram{}) std::abort();
    return;
  }
  std::vector<std::uint8_t> again(datagram.size());
  if (datagram.size() > max_node_datagram ||
      encode(decoded, key, again).size() != datagram.size() || again != datagram) {
    std::abort();
  }
}

/// `type`: the type of datagram that the input is repaired to.
template <class Datagram>
void check_datagram(DatagramType type, const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  std::vector<std::uint8_t> datagram(data + 1, data + size);
  const MacKey* key = data[0] == 2 ? &fuzz_key : nullptr;
  if (data[0] != 0) mend(datagram, type, key);
  check_again<Datagram>(datagram, &fuzz_key);
  check_again<Datagram>(datagram, nullptr);
}

}  // namespace kinalign
