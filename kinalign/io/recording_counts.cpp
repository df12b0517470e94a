// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_counts.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <initializer_list>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Properties of a schema, behind others.
std::string integers(std::initializer_list<std::string_view> names) {
  std::string properties;
  for (const std::string_view name : names) {
    properties += fmt::format(R"(, "{}": {{"type": "integer"}})", name);
  }
  return properties;
}

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::uint64_t count_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

/// Names are texts of others: bytes that are no UTF-8 become U+FFFD.
std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

McapSchema sender_counts_schema() {
  return {0, "kinalign.SenderCounts", "jsonschema",
          R"({"type": "object", "properties": {"stream": {"type": "string"}, )"
          R"("sender": {"type": "string"}, "node": {"type": "string"})" +
              integers({"messages", "bytes", "frames", "lost", "late", "duplicates", "restarts",
                        "refused"}) +
              R"(}, "required": ["stream", "sender", "messages"]})"};
}

std::string to_json(const std::string& stream, const std::string& sender, const std::string& node,
                    const SenderCounts& counts) {
  Json json{{"stream", stream}, {"sender", sender}};
  if (!node.empty()) json["node"] = node;
  json.update(Json{{"messages", counts.messages},
                   {"bytes", counts.bytes},
                   {"frames", counts.frames},
                   {"lost", counts.order.lost},
                   {"late", counts.order.late},
                   {"duplicates", counts.order.duplicates},
                   {"restarts", counts.order.restarts},
                   {"refused", counts.refused}});
  return line_of(json);
}

std::optional<CountedSender> to_counted_sender(std::string_view json) {
  const Json object = Json::parse(json, nullptr, false);
  if (!object.is_object() || text_of(object, "stream").empty()) return std::nullopt;
  CountedSender counted{
      text_of(object, "stream"), text_of(object, "sender"), text_of(object, "node"), {}};
  SenderCounts& counts = counted.counts;
  counts.messages = count_of(object, "messages");
  counts.bytes = count_of(object, "bytes");
  counts.frames = count_of(object, "frames");
  counts.order.lost = count_of(object, "lost");
  counts.order.late = count_of(object, "late");
  counts.order.duplicates = count_of(object, "duplicates");
  counts.order.restarts = count_of(object, "restarts");
  counts.refused = count_of(object, "refused");
  return counted;
}

McapSchema port_counts_schema() {
  return {0, "kinalign.PortCounts", "jsonschema",
          R"({"type": "object", "properties": {"stream": {"type": "string"}, )"
          R"("sifted": {"type": "boolean"})" +
              integers({"pieces", "bytes", "refused", "cut", "dropped", "links", "unsent"}) +
              R"(}, "required": ["stream", "pieces"]})"};
}

std::string to_json(const std::string& stream, const PortCounts& counts) {
  Json json{{"stream", stream},          {"pieces", counts.pieces}, {"bytes", counts.bytes},
            {"refused", counts.refused}, {"cut", counts.cut},       {"dropped", counts.dropped},
            {"links", counts.links},     {"unsent", counts.unsent}};
  if (counts.sifted) json["sifted"] = true;
  return line_of(json);
}

std::optional<CountedPort> to_counted_port(std::string_view json) {
  const Json object = Json::parse(json, nullptr, false);
  if (!object.is_object() || text_of(object, "stream").empty()) return std::nullopt;
  CountedPort counted{text_of(object, "stream"), {}};
  PortCounts& counts = counted.counts;
  counts.pieces = count_of(object, "pieces");
  counts.bytes = count_of(object, "bytes");
  counts.refused = count_of(object, "refused");
  counts.cut = count_of(object, "cut");
  counts.dropped = count_of(object, "dropped");
  counts.links = count_of(object, "links");
  counts.unsent = count_of(object, "unsent");
  counts.sifted = object.value("sifted", Json()) == Json(true);
  return counted;
}

}  // namespace kinalign
