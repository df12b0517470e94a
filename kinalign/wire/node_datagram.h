// SPDX-License-Identifier: Apache-2.0
// The common part of all datagrams between a node (a sensor) and the host. Layout:
// docs/formats/imu_node.md. A datagram is read in two steps, because each node has its own key.
// open_envelope() returns the claimed node. decode() (node_frame.h, node_reply.h, clockless.h) then
// checks the MAC and returns the fields.
#pragma once

#include "kinalign/wire/siphash.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

inline constexpr std::uint8_t node_protocol_version = 1;
inline constexpr std::uint32_t node_magic = 0x4b414e44;  // "KAND", the first bytes of a datagram
// The size of the largest datagram, bytes: a frame of 30 full samples with a MAC. node_frame.cpp
// checks this size.
inline constexpr std::size_t max_node_datagram = 1410;

/// The key of one node. A null pointer instead of a key means that the node has no key.
using MacKey = SipHashKey;

// The values of DatagramType are the numbers in the datagram.
enum class DatagramType : std::uint8_t { frame = 1, reply, request, answer, confirm };

/// The sender of a datagram from a node. A datagram from the host repeats the origin of the
/// datagram that it answers.
struct DatagramOrigin {
  std::uint32_t node_id = 0;
  std::uint32_t boot_id = 0;   // new at every start of the node
  std::uint32_t sequence = 0;  // number of the frame or request since the node's start; wraps

  bool operator==(const DatagramOrigin&) const = default;
};

/// The reason for dropping a datagram. Receivers count each reason separately.
enum class [[nodiscard]] NodeRefusal : std::uint8_t{
    none,
    too_short,
    bad_magic,
    unknown_version,  // Envelope::version contains the version
    wrong_length,     // the size differs from the length field
    bad_crc,
    wrong_type,
    no_key,     // the datagram has a MAC, but the receiver has no key to check it
    no_mac,     // the node has a key, but the datagram has no MAC
    wrong_mac,  // the receiver also tries the node's old key while that key is valid
    reserved_bits,
    too_many_samples,
    wrong_fields,  // the fields are shorter or longer than the datagram
};
inline constexpr std::size_t node_refusals = 13;  // including `none`

/// The name of a refusal, as in docs/formats/imu_node.md, for example "bad_crc".
const char* refusal_name(NodeRefusal refusal);

/// A datagram that arrived undamaged. Anyone may have sent it: until the MAC is checked, the origin
/// may only be used to find the key.
struct Envelope {
  std::uint8_t version = 0;  // set even if the version is unknown
  DatagramType type{};
  DatagramOrigin origin;
  bool has_mac = false;
  std::span<const std::uint8_t> datagram;  // a view of the caller's bytes
  /// Set by readers of recordings: the recorder checked the MAC when the datagram arrived.
  bool mac_was_checked = false;
};

/// Checks everything except type and MAC. After a refusal only `version` of the envelope is set.
NodeRefusal open_envelope(std::span<const std::uint8_t> datagram, Envelope& envelope);

}  // namespace kinalign
