// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/slimevr/packet.h"

#include "kinalign/wire/bytes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

using Bytes = std::span<const std::uint8_t>;

// Head of a datagram: u32 type, u64 number, in network byte order.
// Numbers of types and layouts of bodies: docs/formats/slimevr.md, "A datagram of a tracker".
constexpr std::size_t head_size = 12;
// Types of datagrams that hold several packets.
constexpr std::uint32_t bundle = 100, compact_bundle = 101;

/// A byte reader that can also skip bytes and take text.
class Body {
 public:
  explicit Body(Bytes bytes) : bytes_(bytes), reader_(bytes) {}

  std::uint8_t byte() { return reader_.take<std::uint8_t>(); }
  std::uint16_t word() { return reader_.take<std::uint16_t>(); }
  std::uint32_t number() { return reader_.take<std::uint32_t>(); }
  float real() { return reader_.take_float(); }
  /// Takes a fixed-point number of 16 bits with a sign.
  float fixed(float scale) { return static_cast<float>(static_cast<std::int16_t>(word())) / scale; }
  std::array<float, 3> vector() {
    std::array<float, 3> v{};
    for (float& x : v) x = real();
    return v;
  }
  std::array<float, 4> quaternion() {
    std::array<float, 4> q{};
    for (float& x : q) x = real();
    return q;
  }
  /// Takes `length` bytes and returns those before the first zero.
  std::string text(std::size_t length) {
    const std::size_t at = bytes_.size() - left();
    // A length beyond the end makes the body incomplete. Only bytes of the packet are taken.
    const bool whole = length <= left();
    for (std::size_t n = std::min(length, left()); n > 0; --n) byte();
    if (!whole) byte();  // makes the body incomplete
    const Bytes text = bytes_.subspan(at, whole ? length : 0);
    return {text.begin(), std::find(text.begin(), text.end(), 0)};
  }
  std::size_t left() const { return reader_.left(); }
  bool complete() const { return reader_.complete(); }

 private:
  Bytes bytes_;
  ByteReader reader_;
};

/// Reads the fields as far as the firmware sends them.
SlimeHandshake take_handshake(Body body) {
  SlimeHandshake hands;
  for (auto* field : {&hands.board, &hands.imu, &hands.mcu}) {
    if (body.left() < 4) return hands;
    *field = static_cast<std::int32_t>(body.number());
  }
  if (body.left() < 16) return hands;
  // 12 bytes that the protocol leaves unused.
  for (int unused = 0; unused < 3; ++unused) body.number();
  hands.protocol = static_cast<std::int32_t>(body.number());
  if (body.left() == 0) return hands;
  std::string firmware = body.text(body.byte());
  if (!body.complete()) return hands;
  hands.firmware = std::move(firmware);
  if (body.left() < 6) return hands;
  SlimeMac mac{};
  for (std::size_t i = 0; i < mac.size(); ++i) mac[i] = body.byte();
  if (mac != SlimeMac{}) hands.mac = mac;
  if (body.left() == 0) return hands;
  hands.tracker = body.byte();
  while (body.left() > 0 && hands.texts.size() < 5) {
    std::string text = body.text(body.byte());
    if (!body.complete()) break;
    hands.texts.push_back(std::move(text));
  }
  return hands;
}

/// Reads the fields as far as the firmware sends them.
SlimeSensorInfo take_sensor_info(Body& body) {
  SlimeSensorInfo info;
  info.sensor = body.byte();
  info.status = body.byte();
  if (body.left() >= 1) info.imu = body.byte();
  if (body.left() < 2) return info;
  info.configuration = body.word();
  if (body.left() >= 1) info.rest_calibrated = body.byte();
  if (body.left() >= 1) info.position = body.byte();
  if (body.left() >= 1) info.data_type = body.byte();
  return info;
}

// The body has volts and level, or the level alone. Its length shows which.
SlimeBattery take_battery(Body& body) {
  SlimeBattery battery;
  battery.level = body.real();
  if (body.left() < 4) return battery;
  battery.volts = battery.level;
  battery.level = body.real();
  return battery;
}

// Types 1 and 16 name their sensor by the type, not by a field.
SlimeMotion take_old_rotation(Body& body, std::uint8_t sensor) {
  SlimeMotion motion;
  motion.sensor = sensor;
  motion.rotation = body.quaternion();
  return motion;
}

// Corrections (data type 2) are no samples. They are decoded, so that the caller can leave them
// out.
SlimeMotion take_rotation_data(Body& body) {
  SlimeMotion motion;
  motion.sensor = body.byte();
  motion.is_correction = body.byte() == 2;
  motion.rotation = body.quaternion();
  body.byte();  // accuracy
  return motion;
}

// The number of the sensor may be absent; the reading is then of sensor 0.
SlimeMotion take_acceleration(Body& body) {
  SlimeMotion motion;
  motion.acceleration = body.vector();
  if (body.left() > 0) motion.sensor = body.byte();
  return motion;
}

// Fixed-point numbers: a component of the quaternion is the number by 32768, an acceleration in
// m/s2 is the number by 128.
SlimeMotion take_both(Body& body) {
  SlimeMotion motion;
  motion.sensor = body.byte();
  for (float& x : motion.rotation.emplace()) x = body.fixed(32768.0F);
  for (float& x : motion.acceleration.emplace()) x = body.fixed(128.0F);
  return motion;
}

/// Reads a packet that the program does not use, with the size that its type has.
SlimeReading take_reading(Body& body, std::uint8_t type) {
  SlimeReading reading;
  reading.type = type;
  if (type != 21) reading.sensor = body.byte();
  switch (type) {
    case 18:
    case 20:
    case 26:
      reading.values[0] = body.real();
      break;
    case 19:
      reading.values[0] = static_cast<std::int8_t>(body.byte());
      break;
    case 24:
      reading.values[0] = body.word();
      break;
    case 27:
      reading.values = body.vector();
      break;
    default:
      reading.values[0] = body.byte();
  }
  return reading;
}

SlimeFeatures take_features(Body& body) {
  SlimeFeatures features;
  features.flags.push_back(body.byte());
  while (body.left() > 0) features.flags.push_back(body.byte());
  return features;
}

/// Reads a packet of this type; empty if the type is unknown.
std::optional<SlimePacket> take_body(std::uint32_t type, Body& body) {
  switch (type) {
    case 0:
      return SlimeHeartbeat{};
    case 1:
    case 16:
      return take_old_rotation(body, type == 1 ? 0 : 1);
    case 3:
      return take_handshake(body);
    case 4:
      return take_acceleration(body);
    case 10:
      return SlimePing{body.number()};
    case 11:
      return SlimeSerial{body.text(body.number())};
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
    case 13:
    case 14:
    case 18:
    case 19:
    case 20:
    case 21:
    case 24:
    case 26:
    case 27:
      return take_reading(body, static_cast<std::uint8_t>(type));
    default:
      return std::nullopt;
  }
}

// Readers of required fields do not check lengths: reading beyond the end makes the body
// incomplete, which is tested once at the end.
void take_packet(std::uint32_t type, Bytes bytes, SlimeDatagram& out) {
  Body body(bytes);
  auto packet = take_body(type, body);
  if (!packet) {
    ++out.unknown_type;
  } else if (!body.complete()) {
    ++out.too_short;
  } else {
    out.packets.push_back(std::move(*packet));
  }
}

/// Reads the packets of a bundle. `width`: bytes of each length. A type is as wide in a compact
/// bundle, and has 4 bytes in others.
void take_bundle(Bytes bytes, std::size_t width, SlimeDatagram& out) {
  const std::size_t type_size = width == 1 ? 1 : 4;
  while (bytes.size() >= width) {
    ByteReader reader(bytes);
    std::size_t length = width == 1 ? reader.take<std::uint8_t>() : reader.take<std::uint16_t>();
    bytes = bytes.subspan(width);
    // A length beyond the end is cut to the end, and a length of 0 is skipped, as the SlimeVR
    // server does.
    length = std::min(length, bytes.size());
    if (length == 0) continue;
    const Bytes inner = bytes.first(length);
    bytes = bytes.subspan(length);
    if (length < type_size) {
      ++out.too_short;
      continue;
    }
    ByteReader head(inner);
    const std::uint32_t type = width == 1 ? head.take<std::uint8_t>() : head.take<std::uint32_t>();
    // A bundle within a bundle is refused, so decoding needs no recursion.
    if (type == bundle || type == compact_bundle) {
      ++out.nested;
    } else {
      take_packet(type, inner.subspan(type_size), out);
    }
  }
  if (!bytes.empty()) ++out.too_short;
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
  const Bytes body = datagram.subspan(head_size);
  if (out.type == bundle || out.type == compact_bundle) {
    take_bundle(body, out.type == bundle ? 2 : 1, out);
  } else {
    take_packet(out.type, body, out);
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
