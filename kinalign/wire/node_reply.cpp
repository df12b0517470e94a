// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/node_reply.h"

#include "kinalign/wire/node_layout.h"

namespace kinalign {

namespace {

// Size of reply sequence, nonce and h_tx.
constexpr std::size_t fields_size = 4 + 4 + 8;
constexpr std::uint8_t locked_state = 1;

NodeRefusal take_reply(const NodeHead& head, ByteReader& reader, NodeReply& reply) {
  if ((head.byte21 & ~locked_state) != 0) return NodeRefusal::reserved_bits;
  reply.origin = head.origin;
  reply.locked = head.byte21 != 0;
  reply.reply_sequence = reader.take<std::uint32_t>();
  reply.nonce = reader.take<std::uint32_t>();
  reply.h_tx_ns = reader.take<std::uint64_t>();
  return NodeRefusal::none;
}

}  // namespace

std::span<const std::uint8_t> encode(const NodeReply& reply, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  const std::uint8_t state = reply.locked ? locked_state : 0;
  return encode_as({DatagramType::reply, reply.origin, 0, state, 0}, fields_size, key, out,
                   [&](ByteWriter& writer) {
                     writer.put(reply.reply_sequence);
                     writer.put(reply.nonce);
                     writer.put(reply.h_tx_ns);
                   });
}

NodeRefusal decode(const Envelope& envelope, const MacKey* key, NodeReply& reply) {
  return decode_as(DatagramType::reply, envelope, key, reply, take_reply);
}

}  // namespace kinalign
