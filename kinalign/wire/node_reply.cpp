// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/node_reply.h"

#include "kinalign/wire/node_layout.h"

namespace kinalign {

namespace {

// reply sequence, nonce, h_tx
constexpr std::size_t fields_size = 4 + 4 + 8;
constexpr std::uint8_t locked_state = 1;

NodeRefusal take_reply(const NodeHead& head, ByteReader& reader, NodeReply& reply) {
  if ((head.byte21 & ~locked_state) != 0) return NodeRefusal::stray_bits;
  reply.origin = head.origin;
  reply.locked = head.byte21 != 0;
  reply.reply_sequence = reader.take<std::uint32_t>();
  reply.nonce = reader.take<std::uint32_t>();
  reply.h_tx_ns = reader.take<std::uint64_t>();
  return NodeRefusal::none;
}

}  // namespace

std::size_t encoded_size(const NodeReply&, const MacKey* key) {
  return node_datagram_size(fields_size, key != nullptr);
}

std::span<const std::uint8_t> encode(const NodeReply& reply, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  const std::size_t size = encoded_size(reply, key);
  if (size > out.size()) return {};
  const std::uint8_t state = reply.locked ? locked_state : 0;
  ByteWriter writer =
      begin_datagram(out, size, {DatagramType::reply, reply.origin, 0, state, 0}, key);
  writer.put(reply.reply_sequence);
  writer.put(reply.nonce);
  writer.put(reply.h_tx_ns);
  return seal(out.first(size), key);
}

NodeRefusal decode(const Envelope& envelope, const MacKey* key, NodeReply& reply) {
  return decode_as(DatagramType::reply, envelope, key, reply, take_reply);
}

}  // namespace kinalign
