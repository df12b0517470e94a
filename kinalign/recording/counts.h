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

/// Counts of one sender's data in a take, and of losses by the sender's own numbers.
struct SenderCounts {
  std::uint64_t messages = 0, bytes = 0;  // as received
  std::uint64_t frames = 0;               // complete frames, if the protocol is decoded
  SequenceCounts order;       // lost, late and duplicate frames, if the sender numbers them
  std::uint64_t refused = 0;  // recognised but useless
};
McapSchema sender_counts_schema();
/// Counts since `before`, at least 0.
SenderCounts since(const SenderCounts& before, const SenderCounts& now);
/// The number of frames or, if there are none because the protocol is not decoded, of messages.
std::uint64_t frames_or_messages(const SenderCounts& counts);
/// Returns whether the number is too high for stray datagrams: any program may send one or two.
constexpr bool are_many(std::uint64_t datagrams) { return datagrams >= 20; }
/// Returns whether the sender uses another protocol. True if the protocol is decoded and none of
/// many messages contained a frame, not even a late or duplicate one.
bool speaks_another_protocol(std::string_view recorded_protocol, const SenderCounts& counts);
/// One message of /counts: a sender, identified by stream, address and node, and its counts so far
/// in the take.
struct CountedSender {
  std::string topic, stream, sender;  // topic: the channel of the sender's data
  std::string node;                   // the id of an inertial node, else empty
  SenderCounts counts;
};
std::string to_json(const CountedSender& counted);
/// Missing counts are 0. Absent if the text does not name a stream.
std::optional<CountedSender> to_counted_sender(std::string_view json);

/// Counts of one port's data in a take, and of losses before recording.
struct PortCounts {
  // Datagrams, or reads of a connection.
  std::uint64_t pieces = 0, bytes = 0;
  // from senders beyond the limit; on a mark port also datagrams that are not marks
  std::uint64_t refused = 0;
  std::uint64_t cut = 0;  // datagrams truncated because they were too long
  // by the kernel because its buffer was full; nodes' port: also foreign datagrams
  std::uint64_t dropped = 0;
  std::uint64_t links = 0;   // connections, including those made before the take
  std::uint64_t unsent = 0;  // answers that the system did not accept
  bool sifted = false;       // the kernel drops foreign datagrams and counts them in `dropped`
};
McapSchema port_counts_schema();
/// Counts since `before`, at least 0. `links` and `sifted` keep their present values.
PortCounts since(const PortCounts& before, const PortCounts& now);
/// The least number of foreign datagrams among the dropped ones of a sifted port. The others may be
/// the `lost` frames of its nodes, dropped because the buffer was full.
std::uint64_t foreign_datagrams(const PortCounts& counts, std::uint64_t lost);
/// One message of /counts/ports: a device's port, or a port of marks, and its counts.
struct CountedPort {
  std::string stream;
  PortCounts counts;
};
std::string to_json(const CountedPort& counted);
std::optional<CountedPort> to_counted_port(std::string_view json);

}  // namespace kinalign
