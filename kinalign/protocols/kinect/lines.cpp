// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/lines.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinalign {

namespace {

using Json = nlohmann::json;
using Refusal = KinectRefusal;

constexpr std::string_view schema = "kinalign.kinect/1";

// Each take() reads one type of value. It returns false if the JSON value has another type.

bool take(const Json& json, std::int64_t& to) {
  if (!json.is_number_integer()) return false;
  // The JSON library stores numbers above the largest int64 as unsigned. Their conversion would
  // wrap.
  if (json.is_number_unsigned() && json.get<std::uint64_t>() > INT64_MAX) return false;
  to = json.get<std::int64_t>();
  return true;
}

template <std::unsigned_integral T>
bool take(const Json& json, T& to) {
  std::int64_t wide = 0;
  if (!take(json, wide) || wide < 0 || wide > std::int64_t{std::numeric_limits<T>::max()}) {
    return false;
  }
  to = static_cast<T>(wide);
  return true;
}

bool take(const Json& json, bool& to) {
  if (json.is_boolean()) to = json.get<bool>();
  return json.is_boolean();
}

bool take(const Json& json, std::string& to) {
  if (json.is_string()) to = json.get<std::string>();
  return json.is_string();
}

bool take(const Json& json, float& to) {
  constexpr double most = std::numeric_limits<float>::max();
  // JSON has no NaN and no infinity. Senders write null for a value that is not finite.
  if (json.is_null()) to = std::numeric_limits<float>::quiet_NaN();
  if (json.is_null()) return true;
  if (!json.is_number()) return false;
  const auto wide = json.get<double>();
  if (std::abs(wide) > most) return false;
  to = static_cast<float>(wide);
  return true;
}

template <class T, std::size_t n>
bool take(const Json& json, std::array<T, n>& to) {
  if (!json.is_array() || json.size() != n) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (!take(json[i], to[i])) return false;
  }
  return true;
}

/// Reads an array of 25 rows, one row per joint, into one flat array.
template <std::size_t n>
bool take_rows(const Json& json, std::array<float, n>& to) {
  constexpr std::size_t rows = kinect_joints.size(), width = n / rows;
  if (!json.is_array() || json.size() != rows) return false;
  for (std::size_t j = 0; j < rows; ++j) {
    std::array<float, width> row{};
    if (!take(json[j], row)) return false;
    std::copy(row.begin(), row.end(), to.begin() + static_cast<std::ptrdiff_t>(width * j));
  }
  return true;
}

template <class T>
bool take(const Json& object, const char* key, T& to) {
  const auto found = object.find(key);
  return found != object.end() && take(*found, to);
}

template <class T>
bool take_if_any(const Json& object, const char* key, T& to) {
  return !object.contains(key) || take(object, key, to);
}

template <class T>
bool take_if_any(const Json& object, const char* key, std::optional<T>& to) {
  return !object.contains(key) || take(object, key, to.emplace());
}

// Tracking ids are above 2^53, and many JSON readers store numbers as doubles. An id is therefore
// written as a text of digits.
bool take_id(const Json& object, std::uint64_t& to) {
  std::string digits;
  return take(object, "id", digits) && parse_integer(digits, to);
}

/// Reads a body into the frame. All bodies of a frame must have hands, or none; the same is true
/// for orientations. Unknown keys are ignored, so a sender may add keys.
bool take_body(const Json& object, KinectFrame& frame) {
  KinectBody& body = frame.bodies.emplace_back();
  const bool whole = object.is_object() && take_id(object, body.id) &&
                     take(object, "clipped_edges", body.clipped_edges) &&
                     take(object, "states", body.states) && object.contains("positions") &&
                     take_rows(object["positions"], body.positions);
  if (!whole) return false;
  const bool hands = object.contains("hands"), orientations = object.contains("orientations");
  // The first body decides for all bodies, because a frame has only one flag each for hands and
  // orientations.
  if (frame.bodies.size() == 1) {
    frame.has_hands = hands;
    frame.has_orientations = orientations;
  }
  if (hands != frame.has_hands || orientations != frame.has_orientations) return false;
  std::array<std::uint8_t, 3> hand{};
  if (!take_if_any(object, "hands", hand)) return false;
  body.hand_left = hand[0];
  body.hand_right = hand[1];
  body.hand_confidence = hand[2];
  return !orientations || take_rows(object["orientations"], body.orientations);
}

Refusal take_joint_set(const Json& json) {
  std::string name;
  if (!take(json, "joint_set", name)) return Refusal::wrong_fields;
  return name == "kinect_v2" ? Refusal::none : Refusal::unknown_joint_set;
}

Refusal verdict(bool good) { return good ? Refusal::none : Refusal::wrong_fields; }

Refusal take_hello(const Json& json, const KinectOrigin& origin, KinectMessage& message) {
  KinectHello hello{origin, {}, {}};
  if (!take(json, "serial", hello.serial) || !take(json, "sdk", hello.sdk)) {
    return Refusal::wrong_fields;
  }
  message = std::move(hello);
  return take_joint_set(json);
}

/// Decodes a frame. The keys part, more_parts, utc_us and floor are optional.
Refusal take_frame(const Json& json, const KinectOrigin& origin, KinectMessage& message) {
  if (const auto refusal = take_joint_set(json); refusal != Refusal::none) return refusal;
  KinectFrame frame;
  frame.origin = origin;
  const bool whole =
      take_if_any(json, "part", frame.part) && take_if_any(json, "more_parts", frame.more_parts) &&
      take(json, "device_ticks", frame.device_ticks) &&
      take(json, "taken_ticks", frame.taken_ticks) && take(json, "sent_ticks", frame.sent_ticks) &&
      take_if_any(json, "utc_us", frame.utc_us) && take_if_any(json, "floor", frame.floor);
  const auto bodies = json.find("bodies");
  if (!whole || bodies == json.end() || !bodies->is_array() ||
      bodies->size() > most_kinect_bodies) {
    return Refusal::wrong_fields;
  }
  for (const Json& body : *bodies) {
    if (!take_body(body, frame)) return Refusal::wrong_fields;
  }
  message = std::move(frame);
  return Refusal::none;
}

/// Decodes a ping. Its echo is optional.
Refusal take_ping(const Json& json, const KinectOrigin& origin, KinectMessage& message) {
  KinectPing ping{origin, 0, std::nullopt};
  if (!take(json, "sent_ticks", ping.sent_ticks)) return Refusal::wrong_fields;
  if (const auto found = json.find("echo"); found != json.end()) {
    auto& echo = ping.echo.emplace();
    const bool whole = found->is_object() && take(*found, "pong_sequence", echo.pong_sequence) &&
                       take(*found, "nonce", echo.nonce) &&
                       take(*found, "received_ticks", echo.received_ticks);
    if (!whole) return Refusal::wrong_fields;
  }
  message = ping;
  return Refusal::none;
}

// The host sends pongs and never receives them. Only tests and simulated senders decode them.
Refusal take_pong(const Json& json, const KinectOrigin& origin, KinectMessage& message) {
  KinectPong pong{origin, 0, 0};
  const bool whole =
      take(json, "pong_sequence", pong.pong_sequence) && take(json, "nonce", pong.nonce);
  message = pong;
  return verdict(whole);
}

/// Reads the common fields, and then the fields of the message's type. `room`: bytes of the line,
/// including its end.
Refusal take_message(const Json& json, std::size_t room, KinectMessage& message) {
  if (!json.is_object()) return Refusal::bad_json;
  std::string stated, type;
  if (!take(json, "schema", stated)) return Refusal::wrong_fields;
  if (stated != schema) return Refusal::unknown_version;
  if (!take(json, "type", type)) return Refusal::wrong_fields;
  KinectOrigin origin;
  if (!take(json, "sensor", origin.sensor) || !take(json, "session", origin.session) ||
      !take(json, "sequence", origin.sequence)) {
    return Refusal::wrong_fields;
  }
  if (type == "hello") return take_hello(json, origin, message);
  if (type == "frame") return take_frame(json, origin, message);
  if (type == "pong") return take_pong(json, origin, message);
  if (type != "ping") return Refusal::unknown_type;
  return room < least_kinect_ping_line ? Refusal::too_short : take_ping(json, origin, message);
}

}  // namespace

KinectRefusal decode_kinect_line(std::string_view line, KinectMessage& message) {
  message = {};
  if (line.size() > most_kinect_line) return Refusal::too_long;
  const Json json = Json::parse(line.begin(), line.end(), nullptr, false);
  if (json.is_discarded()) return Refusal::bad_json;
  // The line end counts as one byte, whether it is \n, \r\n or absent. A datagram may have no line
  // end.
  const std::size_t room = line.substr(0, line.find_last_not_of("\r\n") + 1).size() + 1;
  Refusal refusal = take_message(json, room, message);
  if (refusal == Refusal::none) refusal = check(message);
  if (refusal != Refusal::none) message = {};
  return refusal;
}

// A pong contains only numbers and fixed texts, so nothing in it needs JSON's escapes.
std::string encode_kinect_line(const KinectPong& pong) {
  return fmt::format(
      R"({{"schema":"{}","type":"pong","sensor":{},"session":{},"sequence":{},"pong_sequence":{},"nonce":{}}})"
      "\n",
      schema, pong.origin.sensor, pong.origin.session, pong.origin.sequence, pong.pong_sequence,
      pong.nonce);
}

}  // namespace kinalign
