// SPDX-License-Identifier: Apache-2.0
// What a recording counts while it is made: docs/formats/recording.md.
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

/// What has come of a stream in a take, and what its sender's own numbers say of the way.
struct SenderCounts {
  std::uint64_t messages = 0, bytes = 0;  // as they came
  std::uint64_t frames = 0;               // that were complete, where the protocol is decoded
  SequenceCounts order;                   // of these, where the sender numbers them
  std::uint64_t refused = 0;              // recognised and of no use
};
McapSchema sender_counts_schema();
/// Of counts that run on what came after `before`; none below 0.
SenderCounts since(const SenderCounts& before, const SenderCounts& now);
/// Of the frames, where its protocol is decoded, else of the messages.
std::uint64_t frames_or_messages(const SenderCounts& counts);
/// Whether so many are no stray ones: a datagram or two may be anybody's.
constexpr bool are_many(std::uint64_t datagrams) { return datagrams >= 20; }
/// Of a protocol that is decoded: many messages, and nothing of them was a frame, sent again or
/// late either.
bool speaks_another_protocol(std::string_view recorded_protocol, const SenderCounts& counts);
struct CountedSender {
  std::string topic, stream, sender;  // topic: what it sent stands there
  std::string node;                   // of inertial nodes the id, else empty
  SenderCounts counts;
};
std::string to_json(const CountedSender& counted);
/// Counts that are missing are 0; absent where nobody is named.
std::optional<CountedSender> to_counted_sender(std::string_view json);

/// What has come to a port in a take, and what was lost before it could be recorded.
struct PortCounts {
  std::uint64_t pieces = 0, bytes = 0;
  std::uint64_t refused = 0;  // of one sender too many; of marks also what is none
  std::uint64_t cut = 0;      // datagrams longer than any can be
  std::uint64_t dropped = 0;  // by the kernel, for want of room; of nodes also what is no frame
  std::uint64_t links = 0;    // connections that were made, also before the take
  std::uint64_t unsent = 0;   // answers that the system did not take
  bool sifted = false;        // the kernel throws away what is no frame, and counts it so
};
McapSchema port_counts_schema();
/// As of senders; links and sifted as they are now.
PortCounts since(const PortCounts& before, const PortCounts& now);
/// Of a sifted port: how many at least of what was dropped were no frames. The others may be the
/// `lost` ones of its nodes, by their own numbers: for want of room, if not on the way.
std::uint64_t strays(const PortCounts& counts, std::uint64_t lost);
struct CountedPort {
  std::string stream;
  PortCounts counts;
};
std::string to_json(const CountedPort& counted);
std::optional<CountedPort> to_counted_port(std::string_view json);

}  // namespace kinalign
