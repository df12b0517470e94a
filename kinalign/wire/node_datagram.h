// SPDX-License-Identifier: Apache-2.0
// What the datagrams between node and host have in common. Layout: docs/formats/imu_node.md.
// One is read in two steps, since the key depends on the node: open_envelope says which node it is
// said to be from, decode (node_frame.h, node_reply.h, clockless.h) checks the MAC and gives the
// rest.
#pragma once

#include "kinalign/wire/siphash.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

inline constexpr std::uint8_t node_protocol_version = 1;
inline constexpr std::uint32_t node_magic = 0x4b414e44;  // "KAND", its first bytes
inline constexpr std::size_t max_node_datagram = 1410;   // bytes; a buffer of this size holds any

/// A node's own; nullptr in its place means that the node has none.
using MacKey = SipHashKey;

enum class DatagramType : std::uint8_t { frame = 1, reply, request, answer, confirm };

/// Whose datagram it is, or in what the host sends: whose it answers.
struct DatagramOrigin {
  std::uint32_t node_id = 0;
  std::uint32_t boot_id = 0;   // new at every start of the node
  std::uint32_t sequence = 0;  // of frames or requests since then; wraps

  bool operator==(const DatagramOrigin&) const = default;
};

/// Why a datagram is dropped; receivers count each by itself.
enum class [[nodiscard]] NodeRefusal : std::uint8_t{
    none,
    too_short,
    bad_magic,
    unknown_version,  // Envelope::version says which
    wrong_length,     // not the one that the length field says
    bad_crc,
    wrong_type,
    no_key,     // it has a MAC that nothing can be held against
    no_mac,     // the node has a key, and this went without
    wrong_mac,  // try the node's old key while that holds, then count
    stray_bits,
    too_many_samples,
    wrong_fields,  // they end before or behind the datagram
};
inline constexpr std::size_t node_refusals = 13;  // with none: for an array of counts

/// As docs/formats/imu_node.md has it: "bad_crc".
const char* refusal_name(NodeRefusal refusal);

/// A datagram that arrived undamaged. Anyone may have sent it: until the MAC is checked its origin
/// is good for finding the key alone.
struct Envelope {
  std::uint8_t version = 0;  // said of unknown versions too
  DatagramType type{};
  DatagramOrigin origin;
  bool has_mac = false;
  std::span<const std::uint8_t> datagram;  // the caller's bytes, which have to stay
  /// Set by who reads what a recorder accepted: it held the MAC against the key when that came.
  bool mac_was_checked = false;
};

/// Everything but type and MAC; of what is refused `envelope` says the version alone.
NodeRefusal open_envelope(std::span<const std::uint8_t> datagram, Envelope& envelope);

}  // namespace kinalign
