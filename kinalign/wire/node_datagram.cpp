// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/node_datagram.h"

#include "kinalign/wire/crc32.h"
#include "kinalign/wire/node_layout.h"

#include <array>

namespace kinalign {

namespace {

// The names in the order of NodeRefusal.
constexpr std::array<const char*, node_refusals> names{
    "none",       "too_short",        "bad_magic",   "unknown_version", "wrong_length",
    "bad_crc",    "wrong_type",       "no_key",      "no_mac",          "wrong_mac",
    "stray_bits", "too_many_samples", "wrong_fields"};

using Mac = std::array<std::uint8_t, node_mac_size>;

Mac mac_of(const MacKey& key, std::span<const std::uint8_t> bytes) {
  const std::uint64_t hash = siphash_2_4(key, bytes);
  Mac mac{};
  // The lowest byte comes first, as in SipHash's reference implementation and in OpenSSL.
  for (std::size_t i = 0; i < mac.size(); ++i) mac[i] = static_cast<std::uint8_t>(hash >> 8 * i);
  return mac;
}

/// Compares in constant time. If the time depended on the number of equal bytes, a forger could
/// find the MAC byte by byte.
bool same(const Mac& mac, std::span<const std::uint8_t> claimed) {
  std::uint8_t difference = 0;
  for (std::size_t i = 0; i < mac.size(); ++i) {
    difference = static_cast<std::uint8_t>(difference | (mac[i] ^ claimed[i]));
  }
  return difference == 0;
}

NodeRefusal check_mac(const Envelope& envelope, const MacKey* key) {
  // The recorder had the key and checked the MAC. A reader of the recording needs no key.
  if (envelope.mac_was_checked) return NodeRefusal::none;
  // If a node has a key, its datagrams must contain a MAC. Otherwise a forger could avoid the check
  // by sending no MAC.
  if (!envelope.has_mac) return key == nullptr ? NodeRefusal::none : NodeRefusal::no_mac;
  if (key == nullptr) return NodeRefusal::no_key;
  // The MAC covers every byte before it, and the CRC follows it.
  const auto before_crc = envelope.datagram.first(envelope.datagram.size() - node_crc_size);
  const auto covered = before_crc.first(before_crc.size() - node_mac_size);
  return same(mac_of(*key, covered), before_crc.last(node_mac_size)) ? NodeRefusal::none
                                                                     : NodeRefusal::wrong_mac;
}

/// The flags that version 1 allows in a datagram. Unknown flags are refused, because a flag may
/// change the meaning of a field.
std::uint8_t known_flags(DatagramType type) {
  if (type == DatagramType::frame) return mac_flag | battery_flag | echo_flag;
  return type == DatagramType::request ? mac_flag | battery_flag : mac_flag;
}

}  // namespace

const char* refusal_name(NodeRefusal refusal) { return names[static_cast<std::size_t>(refusal)]; }

// The CRC is checked before any further field is used.
NodeRefusal open_envelope(std::span<const std::uint8_t> datagram, Envelope& envelope) {
  envelope = {};
  if (datagram.size() < node_datagram_size(0, false)) return NodeRefusal::too_short;
  ByteReader head(datagram);
  if (head.take<std::uint32_t>() != node_magic) return NodeRefusal::bad_magic;
  envelope.version = head.take<std::uint8_t>();
  if (envelope.version != node_protocol_version) return NodeRefusal::unknown_version;
  // Only magic and version have the same position in every version, so the other fields are read
  // after the version's check.
  const auto type = static_cast<DatagramType>(head.take<std::uint8_t>());
  if (head.take<std::uint16_t>() != datagram.size()) return NodeRefusal::wrong_length;
  ByteReader end(datagram.last(node_crc_size));
  if (end.take<std::uint32_t>() != crc32(datagram.first(datagram.size() - node_crc_size))) {
    return NodeRefusal::bad_crc;
  }
  if (type < DatagramType::frame || type > DatagramType::confirm) return NodeRefusal::wrong_type;
  const DatagramOrigin origin{head.take<std::uint32_t>(), head.take<std::uint32_t>(),
                              head.take<std::uint32_t>()};
  const bool has_mac = (head.take<std::uint8_t>() & mac_flag) != 0;
  // The flags announce a MAC, but the datagram is too short for a MAC.
  if (datagram.size() < node_datagram_size(0, has_mac)) return NodeRefusal::wrong_fields;
  envelope = {node_protocol_version, type, origin, has_mac, datagram, false};
  return NodeRefusal::none;
}

ByteWriter begin_datagram(std::span<std::uint8_t> out, std::size_t size, const NodeHead& head,
                          const MacKey* key) {
  const std::uint8_t mac = key == nullptr ? 0 : mac_flag;
  ByteWriter writer(out.first(size));
  writer.put(node_magic);
  writer.put(node_protocol_version);
  writer.put(static_cast<std::uint8_t>(head.type));
  writer.put(static_cast<std::uint16_t>(size));
  writer.put(head.origin.node_id);
  writer.put(head.origin.boot_id);
  writer.put(head.origin.sequence);
  writer.put(static_cast<std::uint8_t>(head.flags | mac));
  writer.put(head.byte21);
  writer.put(head.battery_mv);
  return writer;
}

// The MAC is written first, because the CRC covers it, too.
std::span<const std::uint8_t> seal(std::span<std::uint8_t> datagram, const MacKey* key) {
  const auto before_crc = datagram.first(datagram.size() - node_crc_size);
  if (key != nullptr) {
    ByteWriter writer(before_crc.last(node_mac_size));
    for (const auto byte : mac_of(*key, before_crc.first(before_crc.size() - node_mac_size))) {
      writer.put(byte);
    }
  }
  ByteWriter(datagram.last(node_crc_size)).put(crc32(before_crc));
  return datagram;
}

NodeRefusal unseal(const Envelope& envelope, DatagramType type, const MacKey* key, NodeHead& head,
                   std::span<const std::uint8_t>& fields) {
  if (envelope.type != type) return NodeRefusal::wrong_type;
  const NodeRefusal refusal = check_mac(envelope, key);
  if (refusal != NodeRefusal::none) return refusal;
  // Byte 20 contains the flags. It follows magic, version, type, length and origin.
  ByteReader reader(envelope.datagram.subspan(20));
  head = {type, envelope.origin, reader.take<std::uint8_t>(), reader.take<std::uint8_t>(),
          reader.take<std::uint16_t>()};
  if ((head.flags & ~known_flags(type)) != 0) return NodeRefusal::reserved_bits;
  // A sender must not send a battery voltage without the battery flag.
  if ((head.flags & battery_flag) == 0 && head.battery_mv != 0) return NodeRefusal::reserved_bits;
  fields = envelope.datagram.subspan(
      node_head_size, envelope.datagram.size() - node_datagram_size(0, envelope.has_mac));
  return NodeRefusal::none;
}

}  // namespace kinalign
