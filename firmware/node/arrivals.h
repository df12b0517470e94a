// SPDX-License-Identifier: Apache-2.0
// Reads the datagrams that have arrived, for both kinds of node.
#pragma once

#include "firmware/node/board.h"

#include "kinalign/wire/node_datagram.h"

#include <array>

namespace kinalign {

inline constexpr std::size_t arrival_room =
    64;  // an answer has 56 bytes; a longer datagram is refused
/// In one poll; so a flood delays a frame by no more than these.
inline constexpr int arrivals_a_poll = 16;

template <class Use>
void for_arrivals(Board& board, Use use) {
  std::array<std::uint8_t, arrival_room> room{};
  std::size_t size = 0;
  for (int i = 0; i < arrivals_a_poll && board.receive(room, size); ++i) {
    use(std::span<const std::uint8_t>(room).first(size));
  }
}

template <class Datagram>
NodeRefusal open_and_decode(std::span<const std::uint8_t> bytes, const MacKey* key,
                            Datagram& datagram) {
  Envelope envelope;
  const NodeRefusal refusal = open_envelope(bytes, envelope);
  return refusal == NodeRefusal::none ? decode(envelope, key, datagram) : refusal;
}

}  // namespace kinalign
