// SPDX-License-Identifier: Apache-2.0
// The contents of a recording's MCAP file, except the data of devices. The specification is
// docs/formats/recording.md and docs/formats/recording_channels.md.
#pragma once

#include "kinalign/clock/exchange.h"
#include "kinalign/clock/offline/clockless.h"
#include "kinalign/clock/utc_anchor.h"
#include "kinalign/mcap/records.h"
#include "kinalign/protocols/marks/mark.h"
#include "kinalign/protocols/protocols.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace kinalign {

/// True if a file that begins with these bytes is an MCAP file.
bool looks_like_recording(std::string_view head);

// The profile in the MCAP header, and the name of the metadata record that identifies a recording.
inline constexpr std::string_view recording_profile = "kinalign";
inline constexpr std::string_view recording_metadata = "kinalign.recording";
inline constexpr std::int64_t latest_log_time = 4'000'000'000'000'000'000;  // ns, the year 2096

/// The metadata record kinalign.recording at the beginning of each file of a recording.
struct RecordingFacts {
  std::string subject, action;
  std::string host;        // the machine's name
  std::string first;       // name of the recording's first file when it was recorded
  int part = 1;            // number of this file in the recording, from 1
  ClockPair anchor;        // relates the clocks: log time = host time + (utc - raw)
  std::set<int> joined{};  // numbers of the parts that recover joined into this file
  Duration utc_minus_host() const {
    return anchor.utc.time_since_epoch() - anchor.raw.time_since_epoch();
  }
  int last_part() const { return joined.empty() ? part : std::max(part, *joined.rbegin()); }
};
McapMetadata to_metadata(const RecordingFacts& facts);
/// Reads the record. The result is empty if a field is missing or is not a number, or if a clock
/// exceeds its limit. The limit of the raw clock is 31 years since its start, and the limit of UTC
/// is latest_log_time.
std::optional<RecordingFacts> to_facts(const McapMetadata& metadata);

/// The metadata record kinalign.devices: the expected devices and whether they are required. The
/// keys are the beginnings of the devices' topics ("mocap", "imu/7").
inline constexpr std::string_view devices_metadata = "kinalign.devices";
using ExpectedDevices = std::map<std::string, bool>;
McapMetadata to_metadata(const ExpectedDevices& devices);
/// The result is empty if the record has another name.
std::optional<ExpectedDevices> to_expected_devices(const McapMetadata& metadata);

/// The metadata record kinalign.end at the end of a recording's last file. `dropped`: messages that
/// reached the recorder, but are in no file because the disk was too slow and the memory was full.
inline constexpr std::string_view end_metadata = "kinalign.end";
struct RecordingEnd {
  std::uint64_t dropped = 0;
};
McapMetadata to_metadata(const RecordingEnd& end);
/// The result is empty if the record has another name or no valid number.
std::optional<RecordingEnd> to_end(const McapMetadata& metadata);

/// The metadata record kinalign.torn. If a recording was truncated, `recover` writes this record
/// instead of kinalign.end.
inline constexpr std::string_view truncated_metadata = "kinalign.torn";

/// How a recording ends, according to its records: no end found, truncated, or ended properly.
enum class Ending : std::uint8_t { none, truncated, ended };
Ending ending_of(const McapMetadata& metadata);

/// The description of a channel of a device's data, stored as the channel's metadata.
struct RawChannel {
  std::string stream;     // the device's name, for example "mocap"
  std::string protocol;   // for example "noitom"
  std::string transport;  // for example "udp"
  std::string sender;     // address and port, for example "192.168.7.20:51234"
  std::string node;       // only for inertial nodes: the id as a decimal number
  std::string place{};    // only for inertial nodes: the place on the body in lab.toml, if any

  bool operator==(const RawChannel&) const = default;
};
McapChannel to_channel(std::string topic, const RawChannel& raw);
std::optional<RawChannel> to_raw(const McapChannel& channel);
/// The protocol of the channel's device; empty if it is not known. For a channel of clock
/// exchanges: inertial nodes if the channel names a node, otherwise Kinect.
std::optional<Protocol> protocol_of(const RawChannel& raw);

/// The channel with the time of the host's two clocks, one pair per second.
inline constexpr std::string_view host_clock_topic = "/clock/host";
/// The schema of this channel, and its messages as JSON.
McapSchema clock_pair_schema();
std::string to_json(const ClockPair& pair);
/// The result is empty if the text is not a pair, or if a clock exceeds the limits of to_facts().
std::optional<ClockPair> to_clock_pair(std::string_view json);

/// A mark and its source: "keyboard", "call" or "trigger". `sender`: the address of a call or
/// trigger.
struct RecordedMark {
  Mark mark;
  std::string source, sender;

  bool operator==(const RecordedMark&) const = default;
};
inline constexpr std::string_view marks_topic = "/marks";
McapSchema mark_schema();
std::string to_json(const RecordedMark& recorded);
std::optional<RecordedMark> to_mark(std::string_view json);

/// A clock exchange as 48 bytes, little-endian. `epoch` increases when the host was suspended,
/// because the host's clock then jumps.
inline constexpr std::string_view exchange_encoding = "kinalign-exchange";
struct RecordedExchange {
  std::uint32_t epoch = 0;
  Exchange exchange;
};
/// The key of a clock model. After a jump of the host's clock (a new epoch), a device needs a new
/// model for the same boot. The lower 32 bits of `boot` are a node's boot id, and the next 16 bits
/// count restarts with the same boot id (capture/nodes/node_table.cpp).
inline BootKey boot_in_epoch(BootKey boot, std::uint32_t epoch) {
  return boot ^ (BootKey{epoch} << 48U);
}
std::string to_bytes(const RecordedExchange& recorded);
/// The result is empty if the bytes are not an exchange, or if one of its clocks has run for more
/// than 31 years.
std::optional<RecordedExchange> to_exchange(std::string_view bytes);

/// A recorded message of a device, with its channel.
struct RecordedMessage {
  const RawChannel* channel = nullptr;
  std::uint16_t channel_id = 0;
  HostTime arrival{};
  std::string_view payload;  // valid until the next message
  bool is_exchange() const { return channel->protocol == exchange_encoding; }
};

/// The arrival of a message with this log time (ns, UTC). A log time is the host's raw clock plus a
/// constant, so the raw clock is restored exactly.
inline HostTime arrival_of(std::uint64_t log_time, Duration utc_minus_host) {
  return HostTime{Duration{static_cast<std::int64_t>(log_time)} - utc_minus_host};
}

/// The clock exchange of a node without a counter, also as 48 bytes. A request that was not
/// confirmed has no times after T2.
struct RecordedClockless {
  std::uint32_t epoch = 0;
  ClocklessExchange exchange;
};
std::string to_bytes(const RecordedClockless& recorded);
std::optional<RecordedClockless> to_clockless(std::string_view bytes);

}  // namespace kinalign
