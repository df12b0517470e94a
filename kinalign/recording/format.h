// SPDX-License-Identifier: Apache-2.0
// What a recording's MCAP file holds beside raw payloads: docs/formats/recording.md, which is
// written first.
#pragma once

#include "kinalign/clock/exchange.h"
#include "kinalign/clock/offline/clockless.h"
#include "kinalign/clock/utc_anchor.h"
#include "kinalign/mcap/records.h"
#include "kinalign/protocols/marks/mark.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace kinalign {

/// Whether a file that begins with these bytes is an MCAP file.
bool looks_like_recording(std::string_view head);

inline constexpr std::string_view recording_profile = "kinalign";
inline constexpr std::string_view recording_metadata = "kinalign.recording";
inline constexpr std::int64_t latest_log_time = 4'000'000'000'000'000'000;  // ns, the year 2096

/// The metadata record of that name, which each file of a recording begins with.
struct RecordingFacts {
  std::string subject, action;
  std::string host;        // the machine's name
  std::string first;       // name of the recording's first file
  int part = 1;            // which file of the recording this is
  ClockPair anchor;        // log times are UTC = host time + (utc - raw), in all of the recording
  std::set<int> joined{};  // of what recover made of several: the files that went into it
  int last_part() const { return joined.empty() ? part : std::max(part, *joined.rbegin()); }
};
McapMetadata to_metadata(const RecordingFacts& facts);
/// Absent where a field is missing or no number, or where a clock is further than its limit: the
/// raw one 31 years from its start, UTC as log times.
std::optional<RecordingFacts> to_facts(const McapMetadata& metadata);

/// The metadata record of that name: who was to be heard, as topics begin ("mocap", "imu/7"), and
/// whether they are required.
inline constexpr std::string_view devices_metadata = "kinalign.devices";
using ExpectedDevices = std::map<std::string, bool>;
McapMetadata to_metadata(const ExpectedDevices& devices);
/// Absent where the record is another.
std::optional<ExpectedDevices> to_expected_devices(const McapMetadata& metadata);

/// The metadata record of that name, which the last file of a recording ends with: messages that
/// reached the recorder and stand in none of its files, because the disk was not as fast as they
/// came and memory was full.
inline constexpr std::string_view end_metadata = "kinalign.end";
struct RecordingEnd {
  std::uint64_t dropped = 0;
};
McapMetadata to_metadata(const RecordingEnd& end);
/// Absent where the record is another, or says no number.
std::optional<RecordingEnd> to_end(const McapMetadata& metadata);

/// The metadata record of that name stands where the end would in what `recover` made of a
/// recording that has none because it was torn.
inline constexpr std::string_view torn_metadata = "kinalign.torn";

/// What a file's records say of the recording behind it.
enum class Ending : std::uint8_t { none, torn, ended };
Ending ending_of(const McapMetadata& metadata);

/// What a channel of raw payloads is, as its metadata.
struct RawChannel {
  std::string stream;     // "mocap"
  std::string protocol;   // "noitom"
  std::string transport;  // "udp"
  std::string sender;     // "192.168.7.20:51234"
  std::string node;       // of inertial nodes: the id, decimal
  std::string place{};    // of these, where the lab says it: where it is worn

  bool operator==(const RawChannel&) const = default;
};
McapChannel to_channel(std::string topic, const RawChannel& raw);
std::optional<RawChannel> to_raw(const McapChannel& channel);

/// Both clocks of the host, once a second.
inline constexpr std::string_view host_clock_topic = "/clock/host";
/// What is said to be a channel's content: schema and the text of its JSON.
McapSchema clock_pair_schema();
std::string to_json(const ClockPair& pair);
/// Absent where it is none, or a clock is further than in the facts.
std::optional<ClockPair> to_clock_pair(std::string_view json);

/// A mark, and who made it: "keyboard", "call" or "trigger"; of the last two the address.
struct RecordedMark {
  Mark mark;
  std::string source, sender;

  bool operator==(const RecordedMark&) const = default;
};
inline constexpr std::string_view marks_topic = "/marks";
McapSchema mark_schema();
std::string to_json(const RecordedMark& recorded);
std::optional<RecordedMark> to_mark(std::string_view json);

/// An exchange as 48 bytes, little-endian. `epoch`: of the host's axis, which begins anew when the
/// host has slept.
inline constexpr std::string_view exchange_encoding = "kinalign-exchange";
struct RecordedExchange {
  std::uint32_t epoch = 0;
  Exchange exchange;
};
/// The host's axis begins anew where it slept: another life for the clock.
inline BootKey life_of(BootKey boot, std::uint32_t epoch) { return boot ^ (BootKey{epoch} << 40U); }
std::string to_bytes(const RecordedExchange& recorded);
/// Absent where the bytes are no exchange, or a clock of it has run for more than 31 years.
std::optional<RecordedExchange> to_exchange(std::string_view bytes);

/// A device's message as it was recorded.
struct RecordedMessage {
  const RawChannel* channel = nullptr;
  std::uint16_t channel_id = 0;
  HostTime arrival{};
  std::string_view payload;  // good until the next message
  bool is_exchange() const { return channel->protocol == exchange_encoding; }
};

/// The arrival of a message that was logged at `log_time`, ns of UTC.
inline HostTime arrival_of(std::uint64_t log_time, Duration utc_minus_host) {
  return HostTime{Duration{static_cast<std::int64_t>(log_time)} - utc_minus_host};
}

/// The same 48 bytes of a node without a counter: of a request the times behind T2 are absent.
struct RecordedClockless {
  std::uint32_t epoch = 0;
  ClocklessExchange exchange;
};
std::string to_bytes(const RecordedClockless& recorded);
std::optional<RecordedClockless> to_clockless(std::string_view bytes);

}  // namespace kinalign
