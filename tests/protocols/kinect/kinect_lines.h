// SPDX-License-Identifier: Apache-2.0
// Writes every message of a Kinect's sender as a line, for tests and the fuzzer. The program itself
// writes pongs only.
#pragma once

#include "kinalign/protocols/kinect/lines.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <concepts>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

namespace kinect_lines {

// The texts are printable ASCII, which `check` ensures. So only quotes and backslashes need an
// escape.
inline std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// The shortest digits that give the same binary32. "-0" gets a decimal point, because readers take
/// "-0" for an integer.
inline std::string number(float value) {
  if (!std::isfinite(value)) return "null";
  if (value == 0.0F && std::signbit(value)) return "-0.0";
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}
inline std::string number(std::integral auto value) { return std::to_string(value); }

template <class T>
inline std::string list(std::span<const T> values) {
  std::string out = "[";
  for (const T value : values) out += (out.size() > 1 ? "," : "") + number(value);
  return out + ']';
}

template <std::size_t n>
inline std::string rows(const std::array<float, n>& values) {
  constexpr std::size_t width = n / kinect_joints.size();
  std::string out = "[";
  for (std::size_t at = 0; at < n; at += width) {
    out += (at > 0 ? "," : "") + list(std::span<const float>(&values[at], width));
  }
  return out + ']';
}

inline std::string text_of(const KinectBody& body, const KinectFrame& frame) {
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
inline std::string begun(const char* type, const KinectOrigin& origin) {
  return std::string("{\"schema\":\"kinalign.kinect/1\",\"type\":\"") + type +
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
    std::string line = encode_kinect_line(pong);
    line.pop_back();
    return line;
  }
};

}  // namespace kinect_lines

/// Encodes a message that `check` accepts, with its line end.
inline std::string encode_kinect_line(const KinectMessage& message) {
  assert(check(message) == KinectRefusal::none);
  return std::visit(kinect_lines::Write{}, message) + '\n';
}

}  // namespace kinalign
