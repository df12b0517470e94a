// SPDX-License-Identifier: Apache-2.0
// Counts that the recorder stores in a recording: docs/formats/recording_channels.md.
#pragma once

#include "kinalign/mcap/records.h"
#include "kinalign/protocols/sequence_count.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

inline constexpr std::string_view sender_counts_topic = "/counts";
inline constexpr std::string_view port_counts_topic = "/counts/ports";

/// Counts of one sender's data in a take. Losses are counted by the numbers that the sender
/// assigns.
struct SenderCounts {
  std::uint64_t messages = 0, bytes = 0;  // as received
  std::uint64_t frames = 0;               // complete frames; 0 if the protocol is not decoded
  SequenceCounts order;       // lost, late and duplicate frames, if the sender numbers frames
  std::uint64_t refused = 0;  // recognised messages that can't be used
};
McapSchema sender_counts_schema();
/// The increase of each count since `before`, at least 0.
SenderCounts since(const SenderCounts& before, const SenderCounts& now);
/// The number of frames or, if the protocol is not decoded, of messages.
std::uint64_t frames_or_messages(const SenderCounts& counts);
/// True if these are too many for accidental datagrams. Any program may send one or two by mistake.
constexpr bool are_many(std::uint64_t datagrams) { return datagrams >= 20; }
/// True if the sender seems to use another protocol: kinalign decodes the protocol, and many
/// messages contained no frame, not even a late or duplicate frame.
bool speaks_another_protocol(std::string_view recorded_protocol, const SenderCounts& counts);
/// Advice to the user of such a sender. Noitom's frames are also refused if they are incomplete.
constexpr std::string_view advice_without_frames(std::string_view recorded_protocol) {
  return recorded_protocol == "noitom"
             ? "check the port and the protocol that the device sends to; if its frames arrive in "
               "several datagrams, use TCP"
             : "check the port and the protocol that the device sends to";
}
/// One message of the channel /counts: a sender and its counts so far in the take. Stream, address
/// and node identify the sender.
struct CountedSender {
  std::string topic, stream, sender;  // `topic`: the channel with the sender's data
  std::string node;                   // the id of an inertial node, else empty
  SenderCounts counts;
};
std::string to_json(const CountedSender& counted);
/// Reads such a message. Missing counts are 0. The result is empty if the text does not name a
/// stream.
std::optional<CountedSender> to_counted_sender(std::string_view json);

/// Counts of one port's data in a take, and of its losses before the data reached the recorder.
struct PortCounts {
  // Datagrams, or reads of a connection.
  std::uint64_t pieces = 0, bytes = 0;
  // Data from senders beyond the limit of senders. On a port for marks, also datagrams that are not
  // marks.
  std::uint64_t refused = 0;
  std::uint64_t cut = 0;  // datagrams truncated because of their length
  // Datagrams that the kernel dropped because its buffer was full. On the nodes' port, also
  // datagrams from other programs.
  std::uint64_t dropped = 0;
  std::uint64_t links = 0;   // connections, including those made before the take
  std::uint64_t unsent = 0;  // answers that the system did not send
  bool sifted = false;       // true if `dropped` also counts datagrams from other programs
};
McapSchema port_counts_schema();
/// The increase of each count since `before`, at least 0. `links` and `sifted` keep their current
/// values.
PortCounts since(const PortCounts& before, const PortCounts& now);
/// A lower limit for the datagrams of other programs among those that the kernel dropped. `lost`:
/// the lost frames of the port's nodes, which the kernel may have dropped because its buffer was
/// full.
std::uint64_t foreign_datagrams(const PortCounts& counts, std::uint64_t lost);
/// One message of the channel /counts/ports: a port of a device or of marks, and its counts.
struct CountedPort {
  std::string stream;
  PortCounts counts;
};
std::string to_json(const CountedPort& counted);
std::optional<CountedPort> to_counted_port(std::string_view json);

}  // namespace kinalign
