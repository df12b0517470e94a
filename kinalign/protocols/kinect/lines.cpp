// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/lines.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

namespace kinalign {

namespace {

using Json = nlohmann::json;
using Refusal = KinectRefusal;

constexpr std::string_view schema = "kinalign.kinect/1";

// ---- reading. Each `take` returns false if the value is of another kind.

bool take(const Json& json, std::int64_t& to) {
  if (!json.is_number_integer()) return false;
  // The JSON library keeps numbers above the largest int64 as unsigned; converting them would wrap.
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
  // JSON has no NaN and no infinity, so a value that is not finite is sent as null.
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

/// Reads an array [25][width].
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

// Tracking ids are above 2^53, and many JSON readers store numbers as doubles. So an id is a text
// of digits.
bool take_id(const Json& object, std::uint64_t& to) {
  std::string digits;
  if (!take(object, "id", digits)) return false;
  const char* end = digits.data() + digits.size();
  const auto [at, error] = std::from_chars(digits.data(), end, to);
  return error == std::errc{} && at == end;
}

/// Reads a body into the frame. All bodies must agree on having hands and orientations.
/// Unknown keys are ignored, so a sender may add keys.
bool take_body(const Json& object, KinectFrame& frame) {
  KinectBody& body = frame.bodies.emplace_back();
  const bool whole = object.is_object() && take_id(object, body.id) &&
                     take(object, "clipped_edges", body.clipped_edges) &&
                     take(object, "states", body.states) && object.contains("positions") &&
                     take_rows(object["positions"], body.positions);
  if (!whole) return false;
  const bool hands = object.contains("hands"), orientations = object.contains("orientations");
  // The first body decides for the frame, because the frame has one flag for all its bodies.
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

/// Decodes a frame; part, more_parts, utc_us and floor are optional.
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

/// Decodes a ping; its echo is optional.
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

// The host only sends pongs; tests and senders decode them.
Refusal take_pong(const Json& json, const KinectOrigin& origin, KinectMessage& message) {
  KinectPong pong{origin, 0, 0};
  const bool whole =
      take(json, "pong_sequence", pong.pong_sequence) && take(json, "nonce", pong.nonce);
  message = pong;
  return verdict(whole);
}

/// Reads the common fields and then those of the type. `room`: bytes of the line with its end.
Refusal take_message(const Json& json, std::size_t room, KinectMessage& message) {
  if (!json.is_object()) return Refusal::bad_json;
  std::string said;
  if (!take(json, "schema", said)) return Refusal::wrong_fields;
  if (said != schema) return Refusal::unknown_version;
  if (!take(json, "type", said)) return Refusal::wrong_fields;
  KinectOrigin origin;
  if (!take(json, "sensor", origin.sensor) || !take(json, "session", origin.session) ||
      !take(json, "sequence", origin.sequence)) {
    return Refusal::wrong_fields;
  }
  if (said == "hello") return take_hello(json, origin, message);
  if (said == "frame") return take_frame(json, origin, message);
  if (said == "pong") return take_pong(json, origin, message);
  if (said != "ping") return Refusal::unknown_type;
  return room < least_kinect_ping_line ? Refusal::too_short : take_ping(json, origin, message);
}

// ---- writing

// The texts are printable ASCII, which `check` ensures. So only quotes and backslashes need an
// escape.
std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// The shortest digits that give the same binary32. "-0" gets a decimal point, because readers take
/// "-0" for an integer.
std::string number(float value) {
  if (!std::isfinite(value)) return "null";
  if (value == 0.0F && std::signbit(value)) return "-0.0";
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}
std::string number(std::integral auto value) { return std::to_string(value); }

template <class T>
std::string list(std::span<const T> values) {
  std::string out = "[";
  for (const T value : values) out += (out.size() > 1 ? "," : "") + number(value);
  return out + ']';
}

template <std::size_t n>
std::string rows(const std::array<float, n>& values) {
  constexpr std::size_t width = n / kinect_joints.size();
  std::string out = "[";
  for (std::size_t at = 0; at < n; at += width) {
    out += (at > 0 ? "," : "") + list(std::span<const float>(&values[at], width));
  }
  return out + ']';
}

std::string text_of(const KinectBody& body, const KinectFrame& frame) {
  const std::array<std::uint8_t, 3> hands{body.hand_left, body.hand_right, body.hand_confidence};
  std::string out =
      "{\"id\":\"" + std::to_string(body.id) + "\",\"clipped_edges\":" + number(body.clipped_edges);
  if (frame.has_hands) out += ",\"hands\":" + list(std::span<const std::uint8_t>(hands));
  out += ",\"states\":" + list(std::span<const std::uint8_t>(body.states));
  out += ",\"positions\":" + rows(body.positions);
  if (frame.has_orientations) out += ",\"orientations\":" + rows(body.orientations);
  return out + '}';
}

// Fields that all messages have. The object stays open.
std::string begun(const char* type, const KinectOrigin& origin) {
  return "{\"schema\":" + json_text(schema) + ",\"type\":\"" + type +
         "\",\"sensor\":" + number(origin.sensor) + ",\"session\":" + number(origin.session) +
         ",\"sequence\":" + number(origin.sequence);
}

/// Encodes the message of each type as one line, without its end.
/// The text is written by hand, so that floats have the shortest digits and the keys have a fixed
/// order.
struct Write {
  std::string operator()(const KinectHello& hello) const {
    return begun("hello", hello.origin) +
           ",\"joint_set\":\"kinect_v2\",\"serial\":" + json_text(hello.serial) +
           ",\"sdk\":" + json_text(hello.sdk) + '}';
  }
  /// Writes optional fields only if the frame has them.
  std::string operator()(const KinectFrame& frame) const {
    std::string out = begun("frame", frame.origin) +
                      ",\"joint_set\":\"kinect_v2\",\"part\":" + number(frame.part) +
                      ",\"more_parts\":" + (frame.more_parts ? "true" : "false") +
                      ",\"device_ticks\":" + number(frame.device_ticks) +
                      ",\"taken_ticks\":" + number(frame.taken_ticks) +
                      ",\"sent_ticks\":" + number(frame.sent_ticks);
    if (frame.utc_us) out += ",\"utc_us\":" + number(*frame.utc_us);
    if (frame.floor) out += ",\"floor\":" + list(std::span<const float>(*frame.floor));
    out += ",\"bodies\":[";
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
      out += (i > 0 ? "," : "") + text_of(frame.bodies[i], frame);
    }
    return out + "]}";
  }
  std::string operator()(const KinectPing& ping) const {
    std::string out = begun("ping", ping.origin) + ",\"sent_ticks\":" + number(ping.sent_ticks);
    if (ping.echo) {
      out += ",\"echo\":{\"pong_sequence\":" + number(ping.echo->pong_sequence) +
             ",\"nonce\":" + number(ping.echo->nonce) +
             ",\"received_ticks\":" + number(ping.echo->received_ticks) + '}';
    }
    out += '}';
    // Blanks after the object are valid JSON. One byte remains for the line end.
    out.resize(std::max(out.size(), least_kinect_ping_line - 1), ' ');
    return out;
  }
  std::string operator()(const KinectPong& pong) const {
    return begun("pong", pong.origin) + ",\"pong_sequence\":" + number(pong.pong_sequence) +
           ",\"nonce\":" + number(pong.nonce) + '}';
  }
};

}  // namespace

KinectRefusal decode_kinect_line(std::string_view line, KinectMessage& message) {
  message = {};
  if (line.size() > most_kinect_line) return Refusal::too_long;
  const Json json = Json::parse(line.begin(), line.end(), nullptr, false);
  if (json.is_discarded()) return Refusal::bad_json;
  // The line end counts as one byte, whether it is \n, \r\n or absent: a datagram may leave it out.
  const std::size_t room = line.substr(0, line.find_last_not_of("\r\n") + 1).size() + 1;
  Refusal refusal = take_message(json, room, message);
  if (refusal == Refusal::none) refusal = check(message);
  if (refusal != Refusal::none) message = {};
  return refusal;
}

std::string encode_kinect_line(const KinectMessage& message) {
  assert(check(message) == Refusal::none);
  return std::visit(Write{}, message) + '\n';
}

}  // namespace kinalign
