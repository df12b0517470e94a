// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/marks/mark_call.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
using Refusal = MarkCallRefusal;

constexpr const char* schema = "kinalign.mark/1";

// The result is empty if the key is missing or its value is not a text. Both are refused for the
// same reason.
std::optional<std::string> text_at(const Json& call, const char* key) {
  const auto found = call.find(key);
  if (found == call.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

bool is_id(std::string_view id) {
  return !id.empty() && id.size() <= 64 &&
         std::all_of(id.begin(), id.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

// Only starts and stops have an effect, so only these marks may have a latency. The negated
// comparison also refuses NaN.
Refusal take_latency(const Json& call, Mark& mark) {
  const auto found = call.find("latency_ms");
  if (found == call.end()) return Refusal::none;
  const bool may = mark.kind == Mark::Kind::start || mark.kind == Mark::Kind::stop;
  if (!may || !found->is_number()) return Refusal::wrong_latency;
  const auto ms = found->get<double>();
  if (!(ms >= 0.0) || ms > most_latency_ms) return Refusal::wrong_latency;
  mark.latency = Duration{std::llround(ms * 1e6)};
  return Refusal::none;
}

// A mark of kind `text` must have a text, because the text is its whole content. Other kinds need
// none.
Refusal take_text(const Json& call, Mark& mark) {
  if (!call.contains("text")) {
    return mark.kind == Mark::Kind::text ? Refusal::wrong_text : Refusal::none;
  }
  const auto text = text_at(call, "text");
  if (!text || text->size() > 500 || !is_mark_text(*text)) return Refusal::wrong_text;
  if (text->empty() && mark.kind == Mark::Kind::text) return Refusal::wrong_text;
  mark.text = *text;
  return Refusal::none;
}

// The schema is checked first, because a datagram without it may come from any other program. The
// id is read before the other checks, so that the answer to a refused call can name the id.
Refusal take(const Json& call, Mark& mark) {
  if (!call.is_object()) return Refusal::bad_json;
  if (text_at(call, "schema") != schema) return Refusal::wrong_schema;
  const auto id = text_at(call, "id");
  if (id && is_id(*id)) mark.id = *id;
  const auto kind = mark_kind_named(text_at(call, "kind").value_or(""));
  if (!kind) return Refusal::wrong_kind;
  mark.kind = *kind;
  if (mark.id.empty()) return Refusal::wrong_id;
  if (const auto refusal = take_latency(call, mark); refusal != Refusal::none) return refusal;
  return take_text(call, mark);
}

/// The text of the answer. It is empty if it would be longer than the call, so that answers can't
/// be used for amplification.
std::string fitting(const Json& answer, std::size_t call_size) {
  const std::string text = answer.dump();
  return text.size() <= call_size ? text : std::string();
}

}  // namespace

const char* name_of(MarkCallRefusal refusal) {
  static constexpr std::array<const char*, mark_call_refusals> names{
      "none",       "too_long", "bad_json",      "wrong_schema",
      "wrong_kind", "wrong_id", "wrong_latency", "wrong_text"};
  return names[static_cast<std::size_t>(refusal)];
}

const char* expected_of(MarkCallRefusal refusal) {
  static constexpr std::array<const char*, mark_call_refusals> texts{
      "a mark",
      "a mark of at most 1200 bytes",
      "a JSON object",
      "a schema of kinalign.mark/1",
      "a kind: start, stop, t_pose or text",
      "an id, 1 to 64 printable ASCII characters",
      "a latency_ms from 0 to 60000, of a start or stop",
      "a text of at most 500 bytes without control characters"};
  return texts[static_cast<std::size_t>(refusal)];
}

MarkCallRefusal decode_mark_call(std::string_view datagram, Mark& mark) {
  mark = {};
  if (datagram.size() > most_mark_call) return Refusal::too_long;
  const Json call = Json::parse(datagram.begin(), datagram.end(), nullptr, false);
  const Refusal refusal = call.is_discarded() ? Refusal::bad_json : take(call, mark);
  // Only the id is kept. The answer to a refused call contains the id.
  if (refusal != Refusal::none) mark = {Mark::Kind::text, "", std::nullopt, std::move(mark.id)};
  return refusal;
}

// Encodes a call as other programs send it. Simulated clicks and tests use it.
std::string encode_mark_call(const Mark& mark) {
  Json call = {{"schema", schema}, {"kind", name_of(mark.kind)}, {"id", mark.id}};
  if (mark.latency) call["latency_ms"] = static_cast<double>(mark.latency->count()) / 1e6;
  if (!mark.text.empty()) call["text"] = mark.text;
  return call.dump();
}

// A repeated call is answered like the first one, because the first answer may have been lost.
std::string answer_to_mark_call(const Mark& mark, MarkAnswer answer, std::size_t call_size) {
  const char* is = answer == MarkAnswer::fresh ? "new" : "repeat";
  return fitting({{"mark", mark.id}, {"is", is}}, call_size);
}

std::string answer_to_refused_call(const Mark& mark, MarkCallRefusal refusal,
                                   std::size_t call_size) {
  if (refusal < Refusal::wrong_kind) return {};  // accepted, or without the schema
  Json answer = Json::object();
  if (!mark.id.empty()) answer["mark"] = mark.id;
  answer["is"] = name_of(refusal);
  return fitting(answer, call_size);
}

}  // namespace kinalign
