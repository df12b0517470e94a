// SPDX-License-Identifier: Apache-2.0
// Datagrams of SlimeVR's trackers, and what is sent to them: docs/formats/slimevr.md. As they stand
// there; slime_orientation and slime_acceleration bring samples into our units.
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

/// What older firmware does not say is absent.
struct SlimeHandshake {
  std::optional<std::int32_t> board, imu, mcu, protocol;
  std::optional<std::string> firmware;
  std::optional<SlimeMac> mac;  // never of zeros
  std::optional<std::uint8_t> tracker;
  std::vector<std::string> texts;  // vendor, its URL, product, update address, update name

  bool operator==(const SlimeHandshake&) const = default;
};

struct SlimeHeartbeat {
  bool operator==(const SlimeHeartbeat&) const = default;
};

/// Types 1, 16, 17, 4 and 23: rotation, acceleration, or both.
struct SlimeMotion {
  std::uint8_t sensor = 0;
  bool is_correction = false;
  std::optional<std::array<float, 4>> rotation;      // x,y,z,w
  std::optional<std::array<float, 3>> acceleration;  // m/s2
};

struct SlimePing {
  std::uint32_t id = 0;
  bool operator==(const SlimePing&) const = default;
};

struct SlimeSensorInfo {
  std::uint8_t sensor = 0, status = 0;
  std::optional<std::uint8_t> imu, rest_calibrated, position, data_type;
  std::optional<std::uint16_t> configuration;

  bool operator==(const SlimeSensorInfo&) const = default;
};

struct SlimeBattery {
  std::optional<float> volts;
  float level = 0.0F;  // of 1
};

struct SlimeSerial {
  std::string text;
  bool operator==(const SlimeSerial&) const = default;
};

struct SlimeFeatures {
  std::vector<std::uint8_t> flags;
  bool operator==(const SlimeFeatures&) const = default;
};

/// Types 13, 14, 18 to 21, 24, 26 and 27, of which nothing here depends.
struct SlimeReading {
  std::uint8_t type = 0, sensor = 0;
  std::array<float, 3> values{};  // one, but of a position three
};

using SlimePacket =
    std::variant<SlimeHeartbeat, SlimeHandshake, SlimeMotion, SlimePing, SlimeSensorInfo,
                 SlimeBattery, SlimeSerial, SlimeFeatures, SlimeReading>;

struct SlimeDatagram {
  std::uint32_t type = 0;
  std::uint64_t number = 0;
  std::vector<SlimePacket> packets;  // of a bundle each, but for …
  std::uint32_t unknown_type = 0;    // … those that we don't know
  std::uint32_t too_short = 0;       // … those that end within what their type has
  std::uint32_t nested = 0;          // … and bundles in it
};

/// False: not even a head, 12 bytes.
[[nodiscard]] bool decode_slime(std::span<const std::uint8_t> datagram, SlimeDatagram& out);

/// Rotation w,x,y,z, unit, from the sensor's space to a world with y up. Absent where it is none.
std::optional<std::array<double, 4>> slime_orientation(const std::array<float, 4>& rotation);

/// m/s2 in the sensor's space, without gravity. `protocol`: of the handshake, 0 where it has none.
std::optional<std::array<double, 3>> slime_acceleration(const std::array<float, 3>& acceleration,
                                                        std::int32_t protocol);

/// What is sent to trackers: a few bytes.
struct SlimeAnswer {
  std::array<std::uint8_t, 64> bytes{};
  std::size_t size = 0;

  std::span<const std::uint8_t> datagram() const { return std::span(bytes).first(size); }
};

inline constexpr std::size_t least_slime_handshake_answer = 13;

/// As long as the handshake, within 13 and 64 bytes.
SlimeAnswer slime_handshake_answer(std::size_t handshake_size);
SlimeAnswer slime_heartbeat();
SlimeAnswer slime_ping(std::uint32_t id);
SlimeAnswer slime_sensor_info_acknowledged(std::uint8_t sensor, std::uint8_t status);
/// Bundles and compact ones are understood.
SlimeAnswer slime_features();

}  // namespace kinalign
