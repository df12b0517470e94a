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
#include <variant>
#include <vector>

namespace kinalign {

using SlimeMac = std::array<std::uint8_t, 6>;

/// A tracker's introduction. Fields that older firmware does not send are absent.
struct SlimeHandshake {
  std::optional<std::int32_t> protocol;
  std::optional<SlimeMac> mac;  // absent also if the tracker sends only zeros
};

/// Motion of one sensor, types 1, 16, 17, 4 and 23: rotation, acceleration, or both.
struct SlimeMotion {
  std::uint8_t sensor = 0;
  bool is_correction = false;
  std::optional<std::array<float, 4>> rotation;      // x,y,z,w
  std::optional<std::array<float, 3>> acceleration;  // m/s2
};

/// State of one sensor. The host acknowledges it with the same status.
struct SlimeSensorInfo {
  std::uint8_t sensor = 0, status = 0;
};

/// State of the tracker's battery. Some trackers send only its level.
struct SlimeBattery {
  std::optional<float> volts;
};

/// Features that the tracker's firmware has. The host answers with its own.
struct SlimeFeatures {};

/// A heartbeat, a returned ping, or another packet that this program does not use. Its body is not
/// read.
struct SlimeOther {};

using SlimePacket = std::variant<SlimeOther, SlimeHandshake, SlimeMotion, SlimeSensorInfo,
                                 SlimeBattery, SlimeFeatures>;

/// A decoded datagram. Packets of an unknown type, and those that are too short for their type, are
/// left out; they do not invalidate the other packets of a bundle.
struct SlimeDatagram {
  std::uint32_t type = 0;
  std::uint64_t number = 0;
  std::vector<SlimePacket> packets;  // at most one, or those of a bundle
};

/// Decodes a datagram. False if it is shorter than its head of 12 bytes.
[[nodiscard]] bool decode_slime(std::span<const std::uint8_t> datagram, SlimeDatagram& out);

/// Unit rotation w,x,y,z from sensor space to a world with y up. Absent if `rotation`
/// is not finite or nearly 0.
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
