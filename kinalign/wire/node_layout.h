// SPDX-License-Identifier: Apache-2.0
// Head and end of a node's datagram, for the files that know the fields between: encode puts a
// head, its fields, and seals; decode unseals and takes the fields. Layout:
// docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/bytes.h"
#include "kinalign/wire/node_datagram.h"

namespace kinalign {

inline constexpr std::size_t node_head_size = 24;
inline constexpr std::size_t node_mac_size = 8;
inline constexpr std::size_t node_crc_size = 4;

/// Of a datagram with so many bytes of fields behind its head.
constexpr std::size_t node_datagram_size(std::size_t fields, bool has_mac) {
  return node_head_size + fields + (has_mac ? node_mac_size : 0) + node_crc_size;
}

inline constexpr std::uint8_t mac_flag = 1, battery_flag = 2, echo_flag = 4;

struct NodeHead {
  DatagramType type{};
  DatagramOrigin origin;
  std::uint8_t flags = 0;  // but for the MAC's
  std::uint8_t byte21 = 0;
  std::uint16_t battery_mv = 0;
};

/// A datagram of `size` bytes begun in `out`, which has the room.
ByteWriter begin_datagram(std::span<std::uint8_t> out, std::size_t size, const NodeHead& head,
                          const MacKey* key);

/// The same with MAC and CRC in its last bytes.
std::span<const std::uint8_t> seal(std::span<std::uint8_t> datagram, const MacKey* key);

/// Type and MAC are checked before anything is told; `fields` is what lies between head and end.
NodeRefusal unseal(const Envelope& envelope, DatagramType type, const MacKey* key, NodeHead& head,
                   std::span<const std::uint8_t>& fields);

/// Fills `out` by take(head, reader, out) from a datagram that is right in everything else; after a
/// refusal `out` is as new.
template <class Out, class Take>
NodeRefusal decode_as(DatagramType type, const Envelope& envelope, const MacKey* key, Out& out,
                      Take take) {
  out = {};
  NodeHead head;
  std::span<const std::uint8_t> fields;
  NodeRefusal refusal = unseal(envelope, type, key, head, fields);
  if (refusal != NodeRefusal::none) return refusal;
  ByteReader reader(fields);
  refusal = take(head, reader, out);
  if (refusal == NodeRefusal::none && (!reader.complete() || reader.left() != 0)) {
    refusal = NodeRefusal::wrong_fields;
  }
  if (refusal != NodeRefusal::none) out = {};
  return refusal;
}

}  // namespace kinalign
