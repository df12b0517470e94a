// SPDX-License-Identifier: Apache-2.0
// Decodes datagrams of SlimeVR's trackers and encodes the answers to them: docs/formats/slimevr.md.
// Values are in the tracker's units and axes; slime_orientation and slime_acceleration convert them
// to ours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

using SlimeMac = std::array<std::uint8_t, 6>;

/// A tracker's introduction. Fields that older firmware does not send are absent.
struct SlimeHandshake {
  std::optional<std::int32_t> board, imu, mcu, protocol;
  std::optional<std::string> firmware;
  std::optional<SlimeMac> mac;  // absent also if the tracker sends only zeros
  std::optional<std::uint8_t> tracker;
  std::vector<std::string> texts;  // vendor, its URL, product, update address, update name

  bool operator==(const SlimeHandshake&) const = default;
};

/// Sign of life without content.
struct SlimeHeartbeat {
  bool operator==(const SlimeHeartbeat&) const = default;
};

/// Motion of one sensor, types 1, 16, 17, 4 and 23: rotation, acceleration, or both.
struct SlimeMotion {
  std::uint8_t sensor = 0;
  bool is_correction = false;
  std::optional<std::array<float, 4>> rotation;      // x,y,z,w
  std::optional<std::array<float, 3>> acceleration;  // m/s2
};

/// The host's own ping, which the tracker returns byte for byte. Its number is the host's 0.
struct SlimePing {
  std::uint32_t id = 0;
  bool operator==(const SlimePing&) const = default;
};

/// State of one sensor. The host acknowledges it with the same status.
struct SlimeSensorInfo {
  std::uint8_t sensor = 0, status = 0;
  std::optional<std::uint8_t> imu, rest_calibrated, position, data_type;
  std::optional<std::uint16_t> configuration;

  bool operator==(const SlimeSensorInfo&) const = default;
};

/// State of the tracker's battery. Some trackers send only the level.
struct SlimeBattery {
  std::optional<float> volts;
  float level = 0.0F;  // charge, 0 to 1
};

struct SlimeSerial {
  std::string text;
  bool operator==(const SlimeSerial&) const = default;
};

/// Features that the tracker's firmware has, one bit each.
struct SlimeFeatures {
  std::vector<std::uint8_t> flags;
  bool operator==(const SlimeFeatures&) const = default;
};

/// Types 13, 14, 18 to 21, 24, 26 and 27, which this program does not use.
struct SlimeReading {
  std::uint8_t type = 0, sensor = 0;
  std::array<float, 3> values{};  // one value; a position has three
};

using SlimePacket =
    std::variant<SlimeHeartbeat, SlimeHandshake, SlimeMotion, SlimePing, SlimeSensorInfo,
                 SlimeBattery, SlimeSerial, SlimeFeatures, SlimeReading>;

/// A decoded datagram. Packets that can't be read are counted; they do not invalidate the other
/// packets of a bundle.
struct SlimeDatagram {
  std::uint32_t type = 0;
  std::uint64_t number = 0;
  std::vector<SlimePacket> packets;  // one, or those of a bundle
  std::uint32_t unknown_type = 0;    // packets of an unknown type
  std::uint32_t too_short = 0;       // packets that end too early for their type
  std::uint32_t nested = 0;          // bundles within a bundle
};

/// Decodes a datagram. False if it is shorter than its head of 12 bytes.
[[nodiscard]] bool decode_slime(std::span<const std::uint8_t> datagram, SlimeDatagram& out);

/// Unit rotation w,x,y,z from sensor space to a world with y up. Absent if `rotation` is no
/// rotation.
std::optional<std::array<double, 4>> slime_orientation(const std::array<float, 4>& rotation);

/// Acceleration, m/s2, in sensor space, without gravity. `protocol`: that of the handshake; 0 if it
/// has none.
std::optional<std::array<double, 3>> slime_acceleration(const std::array<float, 3>& acceleration,
                                                        std::int32_t protocol);

/// A datagram to a tracker.
struct SlimeAnswer {
  std::array<std::uint8_t, 64> bytes{};
  std::size_t size = 0;

  std::span<const std::uint8_t> datagram() const { return std::span(bytes).first(size); }
};

/// The firmware compares this many bytes of the answer; a shorter one is no answer.
inline constexpr std::size_t least_slime_handshake_answer = 13;

/// The answer to a handshake; it is as long as the handshake, but at least 13 and at most 64 bytes.
SlimeAnswer slime_handshake_answer(std::size_t handshake_size);
/// Sent without being asked: a tracker that receives nothing for three seconds drops the
/// connection.
SlimeAnswer slime_heartbeat();
/// The tracker returns it with the same id.
SlimeAnswer slime_ping(std::uint32_t id);
/// The answer to a sensor info; it repeats the status that the tracker sent.
SlimeAnswer slime_sensor_info_acknowledged(std::uint8_t sensor, std::uint8_t status);
/// Tells the tracker that bundles and compact bundles are understood.
SlimeAnswer slime_features();

}  // namespace kinalign
