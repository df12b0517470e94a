// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/slimevr/packet.h"

#include "kinalign/wire/bytes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

// Head of a datagram: u32 type, u64 number, in network byte order.
// Numbers of types and layouts of bodies: docs/formats/slimevr.md, "A datagram of a tracker".
constexpr std::size_t head_size = 12;
// Types of datagrams that hold several packets.
constexpr std::uint32_t bundle = 100, compact_bundle = 101;

/// Reads the fields as far as the firmware sends them.
SlimeHandshake take_handshake(ByteReader body) {
  // Three numbers of the hardware, and 12 bytes that the protocol leaves unused.
  constexpr std::size_t before_protocol = 24;
  SlimeHandshake hands;
  body.take_bytes(before_protocol);
  const auto protocol = body.take<std::int32_t>();
  if (!body.complete()) return hands;
  hands.protocol = protocol;
  body.take_bytes(body.take<std::uint8_t>());  // the firmware's name
  SlimeMac mac{};
  for (std::uint8_t& byte : mac) byte = body.take<std::uint8_t>();
  if (body.complete() && mac != SlimeMac{}) hands.mac = mac;
  return hands;
}

// The body has volts and level, or the level alone. Its length shows which.
SlimeBattery take_battery(ByteReader& body) {
  const float first = body.take_float();
  return body.left() < 4 ? SlimeBattery{} : SlimeBattery{first};
}

// Types 1 and 16 name their sensor by the type, not by a field.
SlimeMotion take_old_rotation(ByteReader& body, std::uint8_t sensor) {
  SlimeMotion motion;
  motion.sensor = sensor;
  motion.rotation = body.take_floats<4>();
  return motion;
}

// Corrections (data type 2) are no samples. They are decoded, so that the caller can leave them
// out.
SlimeMotion take_rotation_data(ByteReader& body) {
  SlimeMotion motion;
  motion.sensor = body.take<std::uint8_t>();
  motion.is_correction = body.take<std::uint8_t>() == 2;
  motion.rotation = body.take_floats<4>();
  body.take<std::uint8_t>();  // accuracy
  return motion;
}

// The number of the sensor may be absent; the reading is then of sensor 0.
SlimeMotion take_acceleration(ByteReader& body) {
  SlimeMotion motion;
  motion.acceleration = body.take_floats<3>();
  if (body.left() > 0) motion.sensor = body.take<std::uint8_t>();
  return motion;
}

// Fixed-point numbers: a component of the quaternion is the number by 32768, an acceleration in
// m/s2 is the number by 128.
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
  body.take<std::uint8_t>();  // at least one byte of flags
  return {};
}

/// Reads a packet of this type; empty if the type is unknown.
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

// Readers of required fields do not check lengths: reading beyond the end makes the body
// incomplete, which is tested once at the end.
void take_packet(std::uint32_t type, ByteReader body, SlimeDatagram& out) {
  auto packet = take_body(type, body);
  if (packet && body.complete()) out.packets.push_back(*packet);
}

bool is_bundle(std::uint32_t type) { return type == bundle || type == compact_bundle; }

/// Reads the packets of a bundle. In a compact one, lengths and types have one byte each.
void take_bundle(ByteReader bytes, bool compact, SlimeDatagram& out) {
  while (bytes.left() > 0) {
    const std::size_t length = compact ? bytes.take<std::uint8_t>() : bytes.take<std::uint16_t>();
    // A length beyond the end is cut to the end, and a length of 0 is skipped, as the SlimeVR
    // server does.
    ByteReader packet(bytes.take_bytes(std::min(length, bytes.left())));
    const std::uint32_t type = compact ? packet.take<std::uint8_t>() : packet.take<std::uint32_t>();
    // A bundle within a bundle is refused, so decoding needs no recursion.
    if (packet.complete() && !is_bundle(type)) take_packet(type, packet, out);
  }
}

void put(SlimeAnswer& answer, std::initializer_list<std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) answer.bytes[answer.size++] = byte;
}

/// Begins an answer: type as u32, number 0 as u64.
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

// Normalizes the quaternion. A norm near 0 has no direction, so it is refused.
std::optional<std::array<double, 4>> slime_orientation(const std::array<float, 4>& rotation) {
  const double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
  const double norm = std::sqrt(w * w + x * x + y * y + z * z);
  if (!std::isfinite(norm) || norm < 1e-3) return std::nullopt;
  // (c, -c, 0, 0) q: -90 degrees about x turn z up into y up
  const double c = std::numbers::sqrt2 / 2.0 / norm;
  return std::array<double, 4>{c * (w + x), c * (x - w), c * (y + z), c * (z - y)};
}

std::optional<std::array<double, 3>> slime_acceleration(const std::array<float, 3>& acceleration,
                                                        std::int32_t protocol) {
  const double x = acceleration[0], y = acceleration[1], z = acceleration[2];
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return std::nullopt;
  /// Firmware before this protocol version sends accelerations in other axes.
  constexpr std::int32_t turned_before = 22;
  if (protocol < turned_before) return std::array<double, 3>{y, -x, z};
  return std::array<double, 3>{x, y, z};
}

SlimeAnswer slime_handshake_answer(std::size_t handshake_size) {
  SlimeAnswer answer;
  // This answer has no head: the firmware compares the bytes from the first one on.
  put(answer, {3, 'H', 'e', 'y', ' ', 'O', 'V', 'R', ' ', '=', 'D', ' ', '5'});
  // The rest of the answer is zeros. An answer that is longer than its handshake could be used for
  // amplification.
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
  // This answer has a type and no number.
  put(answer, {0, 0, 0, 15, sensor, status});
  return answer;
}

SlimeAnswer slime_features() {
  SlimeAnswer answer = begun(22);
  // Bit 0: bundles, bit 1: compact bundles.
  put(answer, {3});
  return answer;
}

}  // namespace kinalign
