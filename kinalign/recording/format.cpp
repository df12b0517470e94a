// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/format.h"

#include "kinalign/core/numbers.h"
#include "kinalign/wire/little_endian_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::string_view format = "1";

/// The value of a key, or an empty text if the key is missing.
std::string text_of(const McapTexts& texts, const std::string& key) {
  const auto found = texts.find(key);
  return found == texts.end() ? std::string() : found->second;
}

/// Reads the number of a key. The whole text must be the number: "12x" means damage.
std::optional<std::int64_t> number_of(const McapTexts& texts, const std::string& key) {
  std::int64_t number = 0;
  return parse_integer(text_of(texts, key), number) ? std::optional(number) : std::nullopt;
}

void append_ns(std::string& out, Duration since) {
  append_little(static_cast<std::uint64_t>(since.count()), out);
}
template <class Stamp>
Stamp take_stamp(LittleEndianReader& from) {
  return Stamp{Duration{static_cast<std::int64_t>(from.take<std::uint64_t>())}};
}

/// True if a clock has run for at most 31 years. Differences of a few stamps then cannot overflow.
template <class Stamp>
bool is_near(Stamp stamp) {
  constexpr Duration furthest{1'000'000'000'000'000'000};
  return -furthest <= stamp.time_since_epoch() && stamp.time_since_epoch() <= furthest;
}

/// The two clocks as a pair; empty if a clock exceeds its limit.
std::optional<ClockPair> believable(HostTime raw, Time utc) {
  if (!is_near(raw) || to_ns(utc) < 0 || to_ns(utc) > latest_log_time) return std::nullopt;
  return ClockPair{raw, utc};
}

/// True for a possible part number. Part numbers occur in file names, and the limit refuses damaged
/// numbers.
bool is_part(std::int64_t number) { return 1 <= number && number <= 1'000'000; }

/// Reads part numbers such as "1 3 4". Other words are ignored.
std::set<int> parts_in(std::string_view text) {
  std::set<int> parts;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    int number = 0;
    if (parse_integer(word, number) && is_part(number)) parts.insert(number);
  }
  return parts;
}

// The flags of an exchange.
constexpr std::uint32_t echoed = 1, clockless = 2;
// A recorded number is 2^32 more than the number of the request. A larger number is damaged.
constexpr std::uint64_t most_frames = std::uint64_t{1} << 33U;  // nine years at 15 Hz

/// The first 16 bytes, which both kinds of exchange have in common.
std::string exchange_head(BootKey boot, std::uint32_t epoch, std::uint32_t flags) {
  std::string out;
  append_little(boot, out);
  append_little(epoch, out);
  append_little(flags, out);
  return out;
}

}  // namespace

/// True for any MCAP file. The profile and the metadata distinguish a recording from other MCAP
/// files.
bool looks_like_recording(std::string_view head) { return head.starts_with(mcap_magic); }

McapMetadata to_metadata(const RecordingFacts& facts) {
  McapMetadata metadata{std::string(recording_metadata),
                        {{"format", std::string(format)},
                         {"subject", facts.subject},
                         {"action", facts.action},
                         {"host", facts.host},
                         {"first", facts.first},
                         {"part", std::to_string(facts.part)},
                         {"raw_ns", std::to_string(facts.anchor.raw.time_since_epoch().count())},
                         {"utc_ns", std::to_string(facts.anchor.utc.time_since_epoch().count())}}};
  if (!facts.joined.empty()) {
    metadata.texts["joined"] = fmt::format("{}", fmt::join(facts.joined, " "));
  }
  return metadata;
}

/// These facts determine how all times of a file are read. If one field is wrong, the whole record
/// is therefore refused.
std::optional<RecordingFacts> to_facts(const McapMetadata& metadata) {
  const McapTexts& texts = metadata.texts;
  const auto part = number_of(texts, "part"), raw = number_of(texts, "raw_ns"),
             utc = number_of(texts, "utc_ns");
  const bool is_ours = metadata.name == recording_metadata && text_of(texts, "format") == format;
  if (!is_ours || !part || !raw || !utc || !is_part(*part)) return std::nullopt;
  const auto anchor = believable(HostTime{Duration{*raw}}, Time{Duration{*utc}});
  if (!anchor) return std::nullopt;
  RecordingFacts facts{text_of(texts, "subject"), text_of(texts, "action"), text_of(texts, "host"),
                       text_of(texts, "first"),   static_cast<int>(*part),  *anchor};
  facts.joined = parts_in(text_of(texts, "joined"));
  return facts;
}

McapMetadata to_metadata(const ExpectedDevices& devices) {
  McapMetadata metadata{std::string(devices_metadata), {}};
  for (const auto& [device, required] : devices) {
    metadata.texts[device] = required ? "required" : "optional";
  }
  return metadata;
}

std::optional<ExpectedDevices> to_expected_devices(const McapMetadata& metadata) {
  if (metadata.name != devices_metadata) return std::nullopt;
  ExpectedDevices devices;
  for (const auto& [device, how] : metadata.texts) devices[device] = how == "required";
  return devices;
}

McapMetadata to_metadata(const RecordingEnd& end) {
  return {std::string(end_metadata), {{"dropped", std::to_string(end.dropped)}}};
}

std::optional<RecordingEnd> to_end(const McapMetadata& metadata) {
  const auto dropped = number_of(metadata.texts, "dropped");
  if (metadata.name != end_metadata || !dropped || *dropped < 0) return std::nullopt;
  return RecordingEnd{static_cast<std::uint64_t>(*dropped)};
}

Ending ending_of(const McapMetadata& metadata) {
  if (metadata.name == end_metadata) return Ending::ended;
  return metadata.name == truncated_metadata ? Ending::truncated : Ending::none;
}

McapChannel to_channel(std::string topic, const RawChannel& raw) {
  McapChannel channel{0, 0, std::move(topic), raw.protocol, {}};
  channel.metadata = {{"stream", raw.stream}, {"transport", raw.transport}, {"sender", raw.sender}};
  if (!raw.node.empty()) channel.metadata["node"] = raw.node;
  if (!raw.place.empty()) channel.metadata["place"] = raw.place;
  return channel;
}

/// Channels of the recorder itself (marks, counts, clocks) have no `transport`, so they are not
/// taken for devices.
std::optional<RawChannel> to_raw(const McapChannel& channel) {
  const std::string stream = text_of(channel.metadata, "stream");
  if (stream.empty() || channel.metadata.count("transport") == 0) return std::nullopt;
  return RawChannel{stream,
                    channel.message_encoding,
                    text_of(channel.metadata, "transport"),
                    text_of(channel.metadata, "sender"),
                    text_of(channel.metadata, "node"),
                    text_of(channel.metadata, "place")};
}

std::optional<Protocol> protocol_of(const RawChannel& raw) {
  if (raw.protocol != exchange_encoding) return find_recorded_protocol(raw.protocol);
  return raw.node.empty() ? Protocol::kinect : Protocol::nodes;
}

McapSchema clock_pair_schema() {
  return {0, "kinalign.ClockPair", "jsonschema",
          R"({"type": "object", "properties": {)"
          R"("raw_ns": {"type": "integer", "description": "CLOCK_MONOTONIC_RAW"}, )"
          R"("utc_ns": {"type": "integer", "description": "CLOCK_REALTIME at that moment"}}, )"
          R"("required": ["raw_ns", "utc_ns"]})"};
}

std::string to_json(const ClockPair& pair) {
  return fmt::format(R"({{"raw_ns": {}, "utc_ns": {}}})", pair.raw.time_since_epoch().count(),
                     pair.utc.time_since_epoch().count());
}

// The text may be damaged. Numbers out of range and clocks beyond their limits are refused.
std::optional<ClockPair> to_clock_pair(std::string_view json) {
  const auto object = nlohmann::json::parse(json, nullptr, false);
  const auto ns = [&](const char* key) -> std::optional<Duration> {
    if (!object.is_object() || !object.contains(key) || !object[key].is_number_integer()) {
      return std::nullopt;
    }
    // Numbers above INT64_MAX would wrap to negative times.
    if (object[key].is_number_unsigned() && object[key].get<std::uint64_t>() > INT64_MAX) {
      return std::nullopt;
    }
    return Duration{object[key].get<std::int64_t>()};
  };
  const auto raw = ns("raw_ns"), utc = ns("utc_ns");
  return raw && utc ? believable(HostTime{*raw}, Time{*utc}) : std::nullopt;
}

McapSchema mark_schema() {
  return {0, "kinalign.Mark", "jsonschema",
          R"({"type": "object", "properties": {)"
          R"("kind": {"enum": ["start", "stop", "t_pose", "text"]}, "text": {"type": "string"}, )"
          R"("latency_ms": {"type": "number", "description": "from the mark to its effect"}, )"
          R"("id": {"type": "string"}, "source": {"enum": ["keyboard", "call", "trigger"]}, )"
          R"("sender": {"type": "string"}}, "required": ["kind", "source"]})"};
}

std::string to_json(const RecordedMark& recorded) {
  const Mark& mark = recorded.mark;
  nlohmann::ordered_json json{{"kind", name_of(mark.kind)}, {"source", recorded.source}};
  if (!mark.text.empty()) json["text"] = mark.text;
  if (mark.latency) json["latency_ms"] = static_cast<double>(mark.latency->count()) / 1e6;
  if (!mark.id.empty()) json["id"] = mark.id;
  if (!recorded.sender.empty()) json["sender"] = recorded.sender;
  // Texts of other programs may not be valid UTF-8. Invalid bytes become U+FFFD.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

// A mark with an impossible latency is refused.
std::optional<RecordedMark> to_mark(std::string_view json) {
  const auto object = nlohmann::json::parse(json, nullptr, false);
  if (!object.is_object()) return std::nullopt;
  const auto text = [&](const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const auto kind = mark_kind_named(text("kind"));
  if (!kind) return std::nullopt;
  std::optional<Duration> latency;
  if (const auto found = object.find("latency_ms"); found != object.end()) {
    const double ms = found->is_number() ? found->get<double>() : -1.0;
    if (!(ms >= 0.0 && ms <= most_latency_ms)) return std::nullopt;
    latency = Duration{std::llround(ms * 1e6)};
  }
  return RecordedMark{{*kind, text("text"), latency, text("id")}, text("source"), text("sender")};
}

std::string to_bytes(const RecordedExchange& recorded) {
  const Exchange& exchange = recorded.exchange;
  const Exchange::Echo echo = exchange.echo.value_or(Exchange::Echo{});
  std::string out = exchange_head(exchange.boot, recorded.epoch, exchange.echo ? echoed : 0U);
  append_ns(out, exchange.n_tx.time_since_epoch());
  append_ns(out, exchange.h_rx.time_since_epoch());
  append_ns(out, echo.n_rx.time_since_epoch());
  append_ns(out, echo.h_tx.time_since_epoch());
  return out;
}

// The bytes of the echo are always present. The flag shows whether they are valid.
std::optional<RecordedExchange> to_exchange(std::string_view bytes) {
  LittleEndianReader from(octets(bytes));
  RecordedExchange recorded;
  recorded.exchange.boot = from.take<std::uint64_t>();
  recorded.epoch = from.take<std::uint32_t>();
  const auto flags = from.take<std::uint32_t>();
  recorded.exchange.n_tx = take_stamp<NodeTime>(from);
  recorded.exchange.h_rx = take_stamp<HostTime>(from);
  const Exchange::Echo echo{take_stamp<NodeTime>(from), take_stamp<HostTime>(from)};
  if (flags == echoed) recorded.exchange.echo = echo;
  // Bytes of another length, or with an unknown flag, belong to another kind of exchange.
  if (!from.complete() || from.left() > 0 || (flags & ~echoed) != 0) return std::nullopt;
  const Exchange& e = recorded.exchange;
  const bool near = is_near(e.n_tx) && is_near(e.h_rx) && is_near(echo.n_rx) && is_near(echo.h_tx);
  return near ? std::optional(recorded) : std::nullopt;
}

std::string to_bytes(const RecordedClockless& recorded) {
  const ClocklessExchange& exchange = recorded.exchange;
  std::string out =
      exchange_head(exchange.boot, recorded.epoch, clockless | (exchange.t6 ? echoed : 0U));
  append_little(exchange.frame, out);
  append_ns(out, exchange.t2.time_since_epoch());
  append_ns(out, exchange.t6.value_or(HostTime{}).time_since_epoch());
  append_ns(out, exchange.t3.time_since_epoch());
  return out;
}

// The bytes of T6 and T3 are always present. The flag shows whether they are valid.
std::optional<RecordedClockless> to_clockless(std::string_view bytes) {
  LittleEndianReader from(octets(bytes));
  RecordedClockless recorded;
  ClocklessExchange& e = recorded.exchange;
  e.boot = from.take<std::uint64_t>();
  recorded.epoch = from.take<std::uint32_t>();
  const auto flags = from.take<std::uint32_t>();
  e.frame = from.take<std::uint64_t>();
  e.t2 = take_stamp<HostTime>(from);
  const auto t6 = take_stamp<HostTime>(from);
  e.t3 = take_stamp<HostTime>(from);
  if (flags == (clockless | echoed)) e.t6 = t6;
  const bool whole = from.complete() && from.left() == 0 && (flags & ~echoed) == clockless;
  const bool near = e.frame <= most_frames && is_near(e.t2) && is_near(e.t3) && is_near(t6);
  return whole && near ? std::optional(recorded) : std::nullopt;
}

}  // namespace kinalign
