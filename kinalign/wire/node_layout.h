// SPDX-License-Identifier: Apache-2.0
// The head and the end that all datagrams of a node share. Each type of datagram has its own file
// for the fields in between. encode_as() and decode_as() join head, fields and end. Layout:
// docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/bytes.h"
#include "kinalign/wire/node_datagram.h"

namespace kinalign {

inline constexpr std::size_t node_head_size = 24;
inline constexpr std::size_t node_mac_size = 8;
inline constexpr std::size_t node_crc_size = 4;

/// The size of a datagram with `fields` bytes after its head.
constexpr std::size_t node_datagram_size(std::size_t fields, bool has_mac) {
  return node_head_size + fields + (has_mac ? node_mac_size : 0) + node_crc_size;
}

inline constexpr std::uint8_t mac_flag = 1, battery_flag = 2, echo_flag = 4;

struct NodeHead {
  DatagramType type{};
  DatagramOrigin origin;
  std::uint8_t flags = 0;  // without the MAC's flag
  // The number of samples in a frame or request; the state in a reply; 0 in other datagrams.
  std::uint8_t byte21 = 0;
  std::uint16_t battery_mv = 0;
};

/// Begins a datagram of `size` bytes in `out`, which must be large enough. `size` includes MAC and
/// CRC, which seal() fills in later.
ByteWriter begin_datagram(std::span<std::uint8_t> out, std::size_t size, const NodeHead& head,
                          const MacKey* key);

/// Adds MAC and CRC in the last bytes of a datagram.
std::span<const std::uint8_t> seal(std::span<std::uint8_t> datagram, const MacKey* key);

/// Checks type and MAC before it returns anything. `fields` becomes the bytes between head and end.
NodeRefusal unseal(const Envelope& envelope, DatagramType type, const MacKey* key, NodeHead& head,
                   std::span<const std::uint8_t>& fields);

/// Encodes a datagram to the front of `out`; `put(writer)` writes its `fields` bytes. The result is
/// empty if `out` is too small.
template <class Put>
std::span<const std::uint8_t> encode_as(const NodeHead& head, std::size_t fields, const MacKey* key,
                                        std::span<std::uint8_t> out, Put put) {
  const std::size_t size = node_datagram_size(fields, key != nullptr);
  if (size > out.size()) return {};
  ByteWriter writer = begin_datagram(out, size, head, key);
  put(writer);
  return seal(out.first(size), key);
}

/// Decodes a datagram. If all checks pass, take(head, reader, out) fills `out`. If decoding is
/// refused, `out` is default-constructed.
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
  // The datagram is too short for its fields, or has bytes after the last field.
  if (refusal == NodeRefusal::none && (!reader.complete() || reader.left() != 0)) {
    refusal = NodeRefusal::wrong_fields;
  }
  if (refusal != NodeRefusal::none) out = {};
  return refusal;
}

}  // namespace kinalign
