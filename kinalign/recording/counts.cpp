// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/counts.h"

#include "kinalign/protocols/protocols.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>

namespace kinalign {

namespace {

/// The keys keep their order, so that a message begins with the names of its sender or port.
/// survey.cpp recognises messages of the same sender by this beginning.
using Json = nlohmann::ordered_json;

/// A count and its name in JSON.
template <class Counts>
struct NamedCount {
  const char* name;
  std::uint64_t& (*in)(Counts&);
};

// The counts of a sender with their names in JSON. Writing, reading, subtraction and the schema all
// use this list.
constexpr std::array<NamedCount<SenderCounts>, 8> of_sender{
    {{"messages", [](SenderCounts& c) -> std::uint64_t& { return c.messages; }},
     {"bytes", [](SenderCounts& c) -> std::uint64_t& { return c.bytes; }},
     {"frames", [](SenderCounts& c) -> std::uint64_t& { return c.frames; }},
     {"lost", [](SenderCounts& c) -> std::uint64_t& { return c.order.lost; }},
     {"late", [](SenderCounts& c) -> std::uint64_t& { return c.order.late; }},
     {"duplicates", [](SenderCounts& c) -> std::uint64_t& { return c.order.duplicates; }},
     {"restarts", [](SenderCounts& c) -> std::uint64_t& { return c.order.restarts; }},
     {"refused", [](SenderCounts& c) -> std::uint64_t& { return c.refused; }}}};

constexpr std::array<NamedCount<PortCounts>, 7> of_port{
    {{"pieces", [](PortCounts& c) -> std::uint64_t& { return c.pieces; }},
     {"bytes", [](PortCounts& c) -> std::uint64_t& { return c.bytes; }},
     {"refused", [](PortCounts& c) -> std::uint64_t& { return c.refused; }},
     {"cut", [](PortCounts& c) -> std::uint64_t& { return c.cut; }},
     {"dropped", [](PortCounts& c) -> std::uint64_t& { return c.dropped; }},
     {"links", [](PortCounts& c) -> std::uint64_t& { return c.links; }},
     {"unsent", [](PortCounts& c) -> std::uint64_t& { return c.unsent; }}}};

/// The properties of these counts in a JSON schema. The text is appended to other properties.
template <class Named>
std::string integers(const Named& named) {
  std::string properties;
  for (const auto& count : named) {
    properties += fmt::format(R"(, "{}": {{"type": "integer"}})", count.name);
  }
  return properties;
}

/// Writes the counts into `json`. `counts` is a copy, because the list gives references that are
/// not const.
template <class Named, class Counts>
void put(const Named& named, Counts counts, Json& json) {
  for (const auto& count : named) json[count.name] = count.in(counts);
}

/// The difference of two counts, at least 0. A count may decrease: a lost frame that arrives late
/// does not count as lost any more.
template <class Named, class Counts>
Counts difference(const Named& named, Counts before, Counts now) {
  Counts out;
  for (const auto& count : named) {
    const std::uint64_t then = count.in(before), is = count.in(now);
    count.in(out) = is > then ? is - then : 0;
  }
  return out;
}

/// The text of a key; empty if the key is missing or has another type. Files may be damaged or of
/// another version.
std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::uint64_t count_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

template <class Named, class Counts>
void take(const Named& named, const Json& object, Counts& counts) {
  for (const auto& count : named) count.in(counts) = count_of(object, count.name);
}

/// The JSON as one line. Names come from other programs: bytes that are not valid UTF-8 become
/// U+FFFD.
std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

McapSchema sender_counts_schema() {
  return {
      0, "kinalign.SenderCounts", "jsonschema",
      R"({"type": "object", "properties": {"topic": {"type": "string"}, )"
      R"("stream": {"type": "string"}, "sender": {"type": "string"}, "node": {"type": "string"})" +
          integers(of_sender) + R"(}, "required": ["stream", "sender", "messages"]})"};
}

SenderCounts since(const SenderCounts& before, const SenderCounts& now) {
  return difference(of_sender, before, now);
}

std::uint64_t frames_or_messages(const SenderCounts& counts) {
  return counts.frames > 0 ? counts.frames : counts.messages;
}

bool speaks_another_protocol(std::string_view recorded_protocol, const SenderCounts& counts) {
  const auto protocol = find_recorded_protocol(recorded_protocol);
  if (!protocol || !row_of(*protocol).has_frame_decoder) return false;
  // Older versions counted refused messages of trackers, but not their frames.
  if (protocol == Protocol::slimevr && counts.refused < counts.messages) return false;
  const bool had_frames = counts.frames + counts.order.late + counts.order.duplicates > 0;
  return !had_frames && are_many(counts.messages);
}

std::string to_json(const CountedSender& counted) {
  Json json{{"topic", counted.topic}, {"stream", counted.stream}, {"sender", counted.sender}};
  if (!counted.node.empty()) json["node"] = counted.node;
  put(of_sender, counted.counts, json);
  return line_of(json);
}

std::optional<CountedSender> to_counted_sender(std::string_view json) {
  const Json object = Json::parse(json, nullptr, false);
  if (!object.is_object() || text_at(object, "stream").empty()) return std::nullopt;
  CountedSender counted{text_at(object, "topic"),
                        text_at(object, "stream"),
                        text_at(object, "sender"),
                        text_at(object, "node"),
                        {}};
  take(of_sender, object, counted.counts);
  return counted;
}

McapSchema port_counts_schema() {
  return {0, "kinalign.PortCounts", "jsonschema",
          R"({"type": "object", "properties": {"stream": {"type": "string"}, )"
          R"("sifted": {"type": "boolean"})" +
              integers(of_port) + R"(}, "required": ["stream", "pieces"]})"};
}

PortCounts since(const PortCounts& before, const PortCounts& now) {
  PortCounts out = difference(of_port, before, now);
  // Connections from before the take still carry data of the take.
  out.links = now.links;
  out.sifted = now.sifted;
  return out;
}

std::uint64_t foreign_datagrams(const PortCounts& counts, std::uint64_t lost) {
  // The kernel may have dropped the lost frames at the same buffer. Only the excess certainly
  // consists of datagrams from other programs.
  return counts.sifted && counts.dropped > lost ? counts.dropped - lost : 0;
}

std::string to_json(const CountedPort& counted) {
  Json json{{"stream", counted.stream}};
  put(of_port, counted.counts, json);
  // `sifted` is written only if it is true, so that older recordings without this key have the same
  // meaning.
  if (counted.counts.sifted) json["sifted"] = true;
  return line_of(json);
}

std::optional<CountedPort> to_counted_port(std::string_view json) {
  const Json object = Json::parse(json, nullptr, false);
  if (!object.is_object() || text_at(object, "stream").empty()) return std::nullopt;
  CountedPort counted{text_at(object, "stream"), {}};
  take(of_port, object, counted.counts);
  counted.counts.sifted = object.value("sifted", Json()) == Json(true);
  return counted;
}

}  // namespace kinalign
