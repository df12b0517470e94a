// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/slimevr/packet.h"

#include "kinalign/wire/bytes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

// The head of a datagram: the type (32 bits) and the number (64 bits), in network byte order. For
// types and layouts see docs/formats/slimevr.md, "A datagram of a tracker".
constexpr std::size_t head_size = 12;
// The types of datagrams that contain several packets.
constexpr std::uint32_t bundle = 100, compact_bundle = 101;

/// Reads the fields of a handshake. Older firmware sends only the first of them.
SlimeHandshake take_handshake(ByteReader body) {
  // Three numbers about the hardware, and 12 unused bytes.
  constexpr std::size_t before_protocol = 24;
  SlimeHandshake hands;
  body.take_bytes(before_protocol);
  const auto protocol = body.take<std::int32_t>();
  if (!body.complete()) return hands;
  hands.protocol = protocol;
  body.take_bytes(body.take<std::uint8_t>());  // skips the name of the firmware
  SlimeMac mac{};
  for (std::uint8_t& byte : mac) byte = body.take<std::uint8_t>();
  if (body.complete() && mac != SlimeMac{}) hands.mac = mac;
  return hands;
}

// Reads volts and level, or the level alone. The length of the body shows which.
SlimeBattery take_battery(ByteReader& body) {
  const float first = body.take_float();
  return body.left() < 4 ? SlimeBattery{} : SlimeBattery{first};
}

// Reads a rotation of type 1 or 16. The type itself determines the sensor.
SlimeMotion take_old_rotation(ByteReader& body, std::uint8_t sensor) {
  SlimeMotion motion;
  motion.sensor = sensor;
  motion.rotation = body.take_floats<4>();
  return motion;
}

// Reads a rotation of type 17. Corrections (data type 2) are not samples. They are decoded, so that
// the caller can drop them.
SlimeMotion take_rotation_data(ByteReader& body) {
  SlimeMotion motion;
  motion.sensor = body.take<std::uint8_t>();
  motion.is_correction = body.take<std::uint8_t>() == 2;
  motion.rotation = body.take_floats<4>();
  body.take<std::uint8_t>();  // skips the accuracy
  return motion;
}

// Reads an acceleration. If the number of the sensor is absent, the reading belongs to sensor 0.
SlimeMotion take_acceleration(ByteReader& body) {
  SlimeMotion motion;
  motion.acceleration = body.take_floats<3>();
  if (body.left() > 0) motion.sensor = body.take<std::uint8_t>();
  return motion;
}

// Reads rotation and acceleration as fixed-point numbers. A quaternion component is the number
// divided by 32768. An acceleration in m/s2 is the number divided by 128.
SlimeMotion take_both(ByteReader& body) {
  SlimeMotion motion;
  motion.sensor = body.take<std::uint8_t>();
  for (float& x : motion.rotation.emplace()) x = body.take<std::int16_t>() / 32768.0F;
  for (float& x : motion.acceleration.emplace()) x = body.take<std::int16_t>() / 128.0F;
  return motion;
}

SlimeSensorInfo take_sensor_info(ByteReader& body) {
  const auto sensor = body.take<std::uint8_t>();
  return {sensor, body.take<std::uint8_t>()};
}

SlimeFeatures take_features(ByteReader& body) {
  body.take<std::uint8_t>();  // skips the flags, at least one byte
  return {};
}

/// Reads a packet of this type. The result is empty if the type is unknown.
std::optional<SlimePacket> take_body(std::uint32_t type, ByteReader& body) {
  switch (type) {
    case 1:
    case 16:
      return take_old_rotation(body, type == 1 ? 0 : 1);
    case 3:
      return take_handshake(body);
    case 4:
      return take_acceleration(body);
    case 12:
      return take_battery(body);
    case 15:
      return take_sensor_info(body);
    case 17:
      return take_rotation_data(body);
    case 22:
      return take_features(body);
    case 23:
      return take_both(body);
    case 0:
    case 10:
    case 11:
    case 13:
    case 14:
    case 18:
    case 19:
    case 20:
    case 21:
    case 24:
    case 26:
    case 27:
      return SlimeOther{};
    default:
      return std::nullopt;
  }
}

// Functions that read required fields do not check lengths. A read beyond the end makes the body
// incomplete, and one check at the end finds that.
void take_packet(std::uint32_t type, ByteReader body, SlimeDatagram& out) {
  auto packet = take_body(type, body);
  if (packet && body.complete()) out.packets.push_back(*packet);
}

bool is_bundle(std::uint32_t type) { return type == bundle || type == compact_bundle; }

/// Reads the packets of a bundle. In a compact bundle, lengths and types have one byte each.
void take_bundle(ByteReader bytes, bool compact, SlimeDatagram& out) {
  while (bytes.left() > 0) {
    const std::size_t length = compact ? bytes.take<std::uint8_t>() : bytes.take<std::uint16_t>();
    // A length beyond the end is cut to the end, and a length of 0 is skipped. The SlimeVR server
    // does the same.
    ByteReader packet(bytes.take_bytes(std::min(length, bytes.left())));
    const std::uint32_t type = compact ? packet.take<std::uint8_t>() : packet.take<std::uint32_t>();
    // A bundle within a bundle is dropped, so decoding needs no recursion.
    if (packet.complete() && !is_bundle(type)) take_packet(type, packet, out);
  }
}

void put(SlimeAnswer& answer, std::initializer_list<std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) answer.bytes[answer.size++] = byte;
}

/// Begins an answer with its type (32 bits) and the number 0 (64 bits).
SlimeAnswer begun(std::uint8_t type) {
  SlimeAnswer answer;
  put(answer, {0, 0, 0, type});
  answer.size = head_size;
  return answer;
}

}  // namespace

bool decode_slime(std::span<const std::uint8_t> datagram, SlimeDatagram& out) {
  out = {};
  ByteReader reader(datagram);
  out.type = reader.take<std::uint32_t>();
  out.number = reader.take<std::uint64_t>();
  if (!reader.complete()) return false;
  if (is_bundle(out.type)) {
    take_bundle(reader, out.type == compact_bundle, out);
  } else {
    take_packet(out.type, reader, out);
  }
  return true;
}

// Normalizes the quaternion. If its norm is nearly 0, the quaternion has no direction, and the
// result is empty.
std::optional<std::array<double, 4>> slime_orientation(const std::array<float, 4>& rotation) {
  const double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
  const double norm = std::sqrt(w * w + x * x + y * y + z * z);
  if (!std::isfinite(norm) || norm < 1e-3) return std::nullopt;
  // Turns z up into y up: the product with (c, -c, 0, 0), a rotation by -90 degrees about x.
  const double c = std::numbers::sqrt2 / 2.0 / norm;
  return std::array<double, 4>{c * (w + x), c * (x - w), c * (y + z), c * (z - y)};
}

std::optional<std::array<double, 3>> slime_acceleration(const std::array<float, 3>& acceleration,
                                                        std::int32_t protocol) {
  const double x = acceleration[0], y = acceleration[1], z = acceleration[2];
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return std::nullopt;
  /// Firmware with a lower protocol version sends accelerations in other axes.
  constexpr std::int32_t turned_before = 22;
  if (protocol < turned_before) return std::array<double, 3>{y, -x, z};
  return std::array<double, 3>{x, y, z};
}

SlimeAnswer slime_handshake_answer(std::size_t handshake_size) {
  SlimeAnswer answer;
  // This answer has no type and number: the firmware compares all bytes from the first one on.
  put(answer, {3, 'H', 'e', 'y', ' ', 'O', 'V', 'R', ' ', '=', 'D', ' ', '5'});
  // The rest of the answer consists of zeros. The answer must not be longer than its handshake;
  // otherwise it could be used for amplification.
  answer.size = std::clamp(handshake_size, least_slime_handshake_answer, answer.bytes.size());
  return answer;
}

SlimeAnswer slime_heartbeat() { return begun(1); }

SlimeAnswer slime_ping(std::uint32_t id) {
  SlimeAnswer answer = begun(10);
  for (int shift = 24; shift >= 0; shift -= 8)
    put(answer, {static_cast<std::uint8_t>(id >> shift)});
  return answer;
}

SlimeAnswer slime_sensor_info_acknowledged(std::uint8_t sensor, std::uint8_t status) {
  SlimeAnswer answer;
  // This answer has a type, but no number.
  put(answer, {0, 0, 0, 15, sensor, status});
  return answer;
}

SlimeAnswer slime_features() {
  SlimeAnswer answer = begun(22);
  // Bit 0: bundles are understood. Bit 1: compact bundles are understood.
  put(answer, {3});
  return answer;
}

}  // namespace kinalign
